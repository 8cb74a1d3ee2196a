// From radiance to display values.
#ifndef BRUME_TONE_H
#define BRUME_TONE_H
#include "shared/shim.h"
SHARED_BEGIN

/// Tone curves.
SHARED_CONST uint kToneNeutral = 0u;   // Khronos PBR Neutral
SHARED_CONST uint kToneStandard = 1u;  // none: clipped at 1, as Blender's "Standard"

/// Khronos PBR Neutral (2024): keeps base colours, compresses and desaturates only highlights.
SHARED_FUNCTION vec3 neutral_tone(vec3 colour) {
  float start = 0.8f - 0.04f;
  float x = min(colour.r, min(colour.g, colour.b));
  colour -= x < 0.08f ? x - 6.25f * x * x : 0.04f;
  float peak = max(colour.r, max(colour.g, colour.b));
  if (peak < start) return colour;
  float d = 1.0f - start;
  float new_peak = 1.0f - d * d / (peak + d - start);
  colour *= new_peak / peak;
  float bleach = 1.0f - 1.0f / (0.15f * (peak - new_peak) + 1.0f);
  return mix(colour, vec3(new_peak), bleach);
}

SHARED_FUNCTION vec3 tone_curve(uint tone, vec3 colour) {
  return tone == kToneStandard ? colour : neutral_tone(colour);
}

/// IEC 61966-2-1.
SHARED_FUNCTION vec3 srgb_from_linear(vec3 linear) {
  vec3 c = clamp(linear, 0.0f, 1.0f);
  return mix(1.055f * pow(c, vec3(1.0f / 2.4f)) - 0.055f, 12.92f * c, lessThanEqual(c, vec3(0.0031308f)));
}

SHARED_END
#endif
