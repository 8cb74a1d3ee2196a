// Radiance to 8 bits: exposure, tone curve, sRGB, and blue noise in each channel against bands.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/blue_noise.glsl"
#include "lib/tone.glsl"
#include "shared/frame.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(binding = 1) uniform sampler2D blue_noise_tile;
layout(binding = 2, rgba16f) uniform readonly image2D picture;
layout(binding = 3, rgba8) uniform writeonly image2D display;

void main() {
  const ivec2 px = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(uvec2(px), frame.size_px))) return;
  // Beside a bulb more comes than a half float holds.
  const vec3 radiance = min(imageLoad(picture, px).rgb, 65504.0) * frame.exposure;
  const vec3 shown = srgb_from_linear(tone_curve(radiance));
  // Noise of one step's width before rounding: on average every value is shown exactly.
  const vec3 noise = blue_noise(blue_noise_tile, px, frame.frame_index).gba - 0.5;
  imageStore(display, px, vec4(clamp(shown + noise / 255.0, 0.0, 1.0), 1.0));
}
