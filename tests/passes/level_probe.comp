// Tests pairs of points in the level: visibility between them, and sky light at the first.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/sky_light.glsl"

#include "probes.h"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindProbeIn) readonly buffer Pairs { PackedVec3 pairs[]; };
layout(scalar, binding = kBindProbeOut) writeonly buffer FreeAnswers { float free[]; };
layout(scalar, binding = kBindProbeOut2) writeonly buffer SkyAnswers {
  vec4 sky[];  // visibility; irradiance from above, below, +x
};

void main() {
  const uint i = gl_GlobalInvocationID.x;
  if (i >= uint(free.length())) return;
  const vec3 p = unpacked(pairs[2u * i]);
  free[i] = segment_visibility(p, unpacked(pairs[2u * i + 1u]));
  sky[i] = vec4(sky_light_at(p).x / sky_shape(0.0), sky_irradiance(p, vec3(0.0, 1.0, 0.0)),
                sky_irradiance(p, vec3(0.0, -1.0, 0.0)), sky_irradiance(p, vec3(1.0, 0.0, 0.0)));
}
