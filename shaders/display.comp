// Radiance to 8 bits: exposure, tone curve, sRGB, and blue noise per channel against banding.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "lib/blue_noise.glsl"
#include "lib/tone.glsl"
#include "shared/display.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindBlueNoise) uniform sampler2D blue_noise_tile;
layout(binding = kBindRadiance, rgba16f) uniform readonly image2D radiance_image;
layout(binding = kBindDisplay, rgba8) uniform writeonly image2D display;
layout(push_constant, scalar) uniform Params { DisplayParams params; };

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), frame.size_px))) return;
  // Next to a light source the radiance exceeds a half float.
  const vec3 radiance = min(imageLoad(radiance_image, px).rgb, 65504.0) * frame.exposure;
  const vec3 shown = srgb_from_linear(tone_curve(radiance));
  // Noise of one quantisation step before rounding keeps every value exact on average.
  const vec3 noise = blue_noise(blue_noise_tile, px, frame.frame_index).gba - 0.5;
  imageStore(display, px, vec4(clamp(shown + noise * (params.dither / 255.0), 0.0, 1.0), 1.0));
}
