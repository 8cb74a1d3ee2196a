// Strengths of holes at given points and times.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/hole.h"

struct Pair {
  Hole hole;
  vec3 p_world;
  float time;
  float rim;
};

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Pairs { Pair pairs[]; };
layout(binding = 1) uniform sampler2D hole_masks;
layout(scalar, binding = 2) writeonly buffer Strengths { float strengths[]; };
#include "lib/hole_mask.glsl"

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(pairs.length())) return;
  strengths[i] = hole_strength_masked(pairs[i].hole, pairs[i].p_world, pairs[i].time, pairs[i].rim);
}
