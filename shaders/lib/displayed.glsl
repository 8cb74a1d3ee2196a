// Radiance as a screen shows it.
#ifndef DISPLAYED_GLSL
#define DISPLAYED_GLSL
#include "lib/blue_noise.glsl"
#include "lib/frame.glsl"
#include "lib/tone.glsl"

layout(binding = kBindBlueNoise) uniform sampler2D blue_noise_tile;

/// A pixel of the display, [0, 1]: exposure, tone curve, sRGB, and blue noise per channel against banding. `dither`:
/// size of the noise in steps of 8 bits.
vec4 displayed(ivec2 px, vec3 radiance, float dither) {
  // Next to a light source the radiance exceeds a half float.
  const vec3 shown = srgb_from_linear(tone_curve(min(radiance, 65504.0) * frame.exposure));
  // Noise of one quantisation step before rounding keeps every value exact on average.
  const vec3 noise = blue_noise(blue_noise_tile, px, frame.frame_index).gba - 0.5;
  return vec4(clamp(shown + noise * (dither / 255.0), 0.0, 1.0), 1.0);
}

#endif
