// Particles over the image: their radiance, and what passes through them of the radiance behind.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/display.h"
#include "shared/particles.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindParticleLayer) uniform sampler2D layer;
layout(binding = kBindRadiance, rgba16f) uniform image2D radiance_image;

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(px, imageSize(radiance_image)))) return;
  const vec4 over = texelFetch(layer, px, 0);
  const vec4 behind = imageLoad(radiance_image, px);
  // The alpha of the image remains, and pixels without particles as they are, bit for bit.
  if (over != vec4(0.0, 0.0, 0.0, 1.0)) imageStore(radiance_image, px, vec4(over.rgb + over.a * behind.rgb, behind.a));
}
