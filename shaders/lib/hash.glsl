// Random numbers from integers.
#ifndef HASH_GLSL
#define HASH_GLSL
#include "shared/hash.h"

/// Three values in [0, 1).
vec3 hash3(uvec3 v) { return vec3(pcg3d(v) >> 8u) * (1.0 / 16777216.0); }

#endif
