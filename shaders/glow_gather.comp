// Mean radiance over all directions of what glows in a volume, that arrives straight (shared/glow_field.h).
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/glow_field.h"
#include "shared/sky_light.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindGlowSwept) uniform sampler3D swept;
layout(binding = kBindGlowFieldTarget, rgba16f) uniform writeonly image3D field;
layout(scalar, push_constant) uniform Push { GlowFieldParams params; };

void main() {
  const uvec3 cell = gl_GlobalInvocationID;
  vec3 sum = vec3(0.0);
  for (uint i = 0u; i < kSkyDirections; ++i) sum += texelFetch(swept, ivec3(cell) + ivec3(i * kGlowEdge, 0, 0), 0).rgb;
  imageStore(field, ivec3(cell) + ivec3(0, 0, params.volume * kGlowEdge), vec4(sum, 1.0));
}
