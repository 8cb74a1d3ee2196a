// Radiance to 8 bits.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/displayed.glsl"
#include "shared/display.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindRadiance, rgba16f) uniform readonly image2D radiance_image;
layout(binding = kBindDisplay, rgba8) uniform writeonly image2D display;
layout(push_constant, scalar) uniform Params { DisplayParams params; };

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), frame.size_px))) return;
  imageStore(display, px, displayed(px, imageLoad(radiance_image, px).rgb, params.dither));
}
