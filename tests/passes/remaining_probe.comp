// Fraction that single holes leave at given points and times, by the function of the march.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/hole_remaining.glsl"
#include "probes.h"

struct Question {
  PackedVec3 p_world;
  float time;
  float rim_noise;
  float rim;
};

layout(local_size_x = 64) in;
layout(scalar, binding = kBindProbeIn) readonly buffer Questions { Question questions[]; };
layout(scalar, binding = kBindProbeOut) writeonly buffer Remaining { float remaining[]; };

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(questions.length())) return;
  const Question q = questions[i];
  remaining[i] = remaining_after_hole(i, hole_front(i), unpacked(q.p_world), q.time, q.rim_noise, q.rim);
}
