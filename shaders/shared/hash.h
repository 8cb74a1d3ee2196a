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

SHARED_END
#endif
