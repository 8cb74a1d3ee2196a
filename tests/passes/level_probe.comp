// Asks the level for many pairs of points: whether the way between is free, and what the first sees of the sky.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#define BINDING_SOLID 1
#define BINDING_SKY_LIGHT 2
#include "shared/frame.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 3) readonly buffer Pairs { vec3 pairs[]; };
layout(scalar, binding = 4) writeonly buffer FreeAnswers { float free[]; };
layout(scalar, binding = 5) writeonly buffer SkyAnswers { vec4 sky[]; };  // visibility; irradiance from above, below, +x
#include "lib/sky_light.glsl"

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(free.length())) return;
  const vec3 p = pairs[2u * i];
  free[i] = free_way(p, pairs[2u * i + 1u]);
  sky[i] = vec4(sky_visibility(p), sky_irradiance(p, vec3(0.0, 1.0, 0.0)), sky_irradiance(p, vec3(0.0, -1.0, 0.0)),
                sky_irradiance(p, vec3(1.0, 0.0, 0.0)));
}
