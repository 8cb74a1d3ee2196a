// Random numbers from integers: the same in C++ and in GLSL.
#ifndef BRUME_HASH_H
#define BRUME_HASH_H
#include "shared/shim.h"
SHARED_BEGIN

/// PCG in three dimensions (Jarzynski and Olano 2020, "Hash Functions for GPU Rendering").
SHARED_FUNCTION uvec3 pcg3d(uvec3 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  return v;
}

/// Three values in [0, 1).
SHARED_FUNCTION vec3 hash3(uvec3 v) { return vec3(pcg3d(v) >> 8u) * (1.0f / 16777216.0f); }

SHARED_END
#endif
