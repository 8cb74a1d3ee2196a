// From radiance to display values.
#ifndef TONE_GLSL
#define TONE_GLSL
#include "lib/frame.glsl"

/// Khronos PBR Neutral (2024): keeps base colours, compresses and desaturates only highlights.
vec3 neutral_tone(vec3 colour) {
  const float start = 0.8 - 0.04;
  const float x = min(colour.r, min(colour.g, colour.b));
  colour -= x < 0.08 ? x - 6.25 * x * x : 0.04;
  const float peak = max(colour.r, max(colour.g, colour.b));
  if (peak < start) return colour;
  const float d = 1.0 - start;
  const float new_peak = 1.0 - d * d / (peak + d - start);
  colour *= new_peak / peak;
  const float bleach = 1.0 - 1.0 / (0.15 * (peak - new_peak) + 1.0);
  return mix(colour, vec3(new_peak), bleach);
}

/// The frame's tone curve.
vec3 tone_curve(vec3 colour) { return frame.tone == kToneStandard ? colour : neutral_tone(colour); }

/// IEC 61966-2-1.
vec3 srgb_from_linear(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

#endif
