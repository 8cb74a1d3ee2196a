// What noise leaves of smoke: it eats into its rim and lets billows show inside.
#ifndef BRUME_EROSION_H
#define BRUME_EROSION_H
#include "shared/frame.h"
SHARED_BEGIN

/// Density after the noise: the less smoke there is, the brighter the noise must be for any to stay; where
/// there is very little, threads decide as much as billows, so that what dissolves leaves wisps. Rises with
/// density and with each channel; 0 where the density is 0. Where it is 1 the mean over the noise is 1, so
/// that no line shows along walls, and the most is 1 + 0.5 look.erosion.
SHARED_FUNCTION float erode(SmokeLook look, float density, vec4 noise) {
  // Sums of channels crowd around their middle: spread over [0, 1] again.
  float billows = clamp(1.35f * dot(noise, vec4(0.65f, 0.1f, 0.0f, 0.25f)) - 0.235f, 0.0f, 1.0f);
  float wisps = clamp(1.3f * dot(noise, vec4(0.25f, 0.0f, 0.75f, 0.0f)) - 0.1f, 0.0f, 1.0f);
  float thin = (1.0f - density) * (1.0f - density);
  float threshold = look.erosion * (1.0f - mix(billows, wisps, 0.5f * thin * thin));
  float left = clamp(4.0f * (density - threshold) / max(1.0f - threshold, 0.05f), 0.0f, 1.0f);
  float inside = 1.0f + look.erosion * (0.7f * noise.r + 0.3f * noise.g - 0.5f);
  return left * inside;
}

SHARED_END
#endif
