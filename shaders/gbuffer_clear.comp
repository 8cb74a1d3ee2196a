// No emission, at all pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/gbuffer.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindEmission, rgba16f) uniform writeonly image2D emission;

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (all(lessThan(px, imageSize(emission)))) imageStore(emission, px, vec4(0.0));
}
