// What single holes leave at given points and times, as the march asks them.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/frame.h"

struct Question {
  vec3 p_world;
  float time;
  float rim_noise;
  float rim;
};

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer Questions { Question questions[]; };
layout(binding = 2) readonly buffer Holes { vec4 hole_rows[]; };
layout(binding = 3) uniform sampler2D hole_masks;
layout(scalar, binding = 4) writeonly buffer Left { float left[]; };
#include "lib/hole_remaining.glsl"

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(questions.length())) return;
  const Question q = questions[i];
  left[i] = remaining_after_hole(i, hole_front(i), q.p_world, q.time, q.rim_noise, q.rim);
}
