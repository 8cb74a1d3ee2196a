// Strengths of holes at given points and times.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/hole_mask.glsl"
#include "probes.h"

struct Pair {
  Hole hole;
  vec3 p_world;
  float time;
  float rim;
  vec3 padding;
};

layout(local_size_x = 64) in;
layout(scalar, binding = kBindProbeIn) readonly buffer Pairs { Pair pairs[]; };
layout(scalar, binding = kBindProbeOut) writeonly buffer Strengths { float strengths[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(pairs.length())) return;
  strengths[i] = hole_strength_masked(pairs[i].hole, pairs[i].p_world, pairs[i].time, pairs[i].rim);
}
