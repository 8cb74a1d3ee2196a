// Erosion of smoke by noise: wisps at its rim, billows inside.
#ifndef BRUME_EROSION_H
#define BRUME_EROSION_H
#include "shared/frame.h"
SHARED_BEGIN

/// Density after erosion. The thinner the smoke, the brighter the noise must be for any to remain; in very thin smoke
/// threads count as much as billows, so dissolving smoke turns into wisps. Increases with density and with each noise
/// channel; 0 where the density is 0. At density 1 the mean over the noise is 1, so that no line shows along walls, and
/// the maximum is 1 + 0.5 look.erosion.
SHARED_FUNCTION float erode(SmokeLook look, float density, vec4 noise) {
  // A sum of channels concentrates around its mean: stretch it to [0, 1].
  float billows = clamp(1.35f * dot(noise, vec4(0.65f, 0.1f, 0.0f, 0.25f)) - 0.235f, 0.0f, 1.0f);
  float wisps = clamp(1.3f * dot(noise, vec4(0.25f, 0.0f, 0.75f, 0.0f)) - 0.1f, 0.0f, 1.0f);
  float thin = (1.0f - density) * (1.0f - density);
  float threshold = look.erosion * (1.0f - mix(billows, wisps, 0.5f * thin * thin));
  float remaining = clamp(4.0f * (density - threshold) / max(1.0f - threshold, 0.05f), 0.0f, 1.0f);
  float inside = 1.0f + look.erosion * (0.7f * noise.r + 0.3f * noise.g - 0.5f);
  return remaining * inside;
}

/// Density of even smoke that lets as much light through as smoke of four densities on average, each for a quarter of
/// the rays, of an optical depth `k` per density: -log(mean(exp(-k density))) / k. At most the mean, at least the least
/// of them.
SHARED_FUNCTION float effective_density(vec4 densities, float k) {
  float least = min(min(densities.x, densities.y), min(densities.z, densities.w));
  vec4 more = densities - vec4(least);
  float mean = 0.25f * (more.x + more.y + more.z + more.w);
  // To the second order where rounding would exceed it.
  if (k * mean < 1e-2f) return least + mean - 0.5f * k * (0.25f * dot(more, more) - mean * mean);
  vec4 passed = exp(-k * more);
  return least - log(0.25f * (passed.x + passed.y + passed.z + passed.w)) / k;
}

SHARED_END
#endif
