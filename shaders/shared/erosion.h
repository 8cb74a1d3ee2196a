// Erosion of smoke by noise: wisps at its rim, billows inside.
#ifndef BRUME_EROSION_H
#define BRUME_EROSION_H
#include "shared/frame.h"
SHARED_BEGIN

/// Fraction of a density that erosion leaves. The thinner the smoke, the brighter the noise must be for any to remain;
/// in very thin smoke threads count as much as billows, so dissolving smoke turns into wisps. Increases with density
/// and with each noise channel; 0 where the density is 0.
SHARED_FUNCTION float eroded_fraction(SmokeLook look, float density, vec4 noise) {
  // A sum of channels concentrates around its mean: stretch it to [0, 1].
  float billows = clamp(1.35f * dot(noise, vec4(0.65f, 0.1f, 0.0f, 0.25f)) - 0.235f, 0.0f, 1.0f);
  float wisps = clamp(1.3f * dot(noise, vec4(0.25f, 0.0f, 0.75f, 0.0f)) - 0.1f, 0.0f, 1.0f);
  float thin = (1.0f - density) * (1.0f - density);
  float threshold = look.erosion * (1.0f - mix(billows, wisps, 0.5f * thin * thin));
  // With detail the rim is up to twice as steep, around the same middle.
  float above = 4.0f * (density - threshold) / max(1.0f - threshold, 0.05f);
  return clamp(above + look.detail * (above - 0.5f), 0.0f, 1.0f);
}

/// Density after erosion, by the noise of the tile and by that with its detail, or twice the same. At density 1 the
/// mean over the noise is 1, so that no line shows along walls, and the maximum is 1 + 0.5 look.erosion.
SHARED_FUNCTION float erode(SmokeLook look, float density, vec4 noise, vec4 detailed) {
  float inside = 1.0f + look.erosion * (0.7f * noise.r + 0.3f * noise.g - 0.5f);
  return eroded_fraction(look, density, detailed) * inside;
}

// Detail: two octaves below the noise of the tile, which are the same tile, smaller. Each rises faster than the one
// above, so that billows roll.

/// The point of the tile that an octave has at `p_world`, which is displaced: 0 is the tile itself, 1 and 2 are
/// detail.
SHARED_FUNCTION vec3 noise_point(SmokeLook look, vec3 p_world, float time, uint octave) {
  float faster = 1.0f + 0.25f * float(octave);
  vec3 at = (p_world - vec3(0.0f, faster * look.rise * time, 0.0f)) * look.noise_frequency;
  // No ratio of small numbers, so that the tiles' lattices do not meet.
  if (octave == 1u) return 5.3f * at + vec3(0.31f, 0.17f, 0.73f);
  if (octave == 2u) return 17.9f * at + vec3(0.61f, 0.37f, 0.13f);
  return at;
}

/// Weights of both octaves of detail where a pixel is as wide as `pixel` [m]: an octave fades out as its cells, of
/// which a tile has 16, become narrower than that.
SHARED_FUNCTION vec2 detail_weights(SmokeLook look, float pixel) {
  float cells = 16.0f * look.noise_frequency * pixel;
  vec2 shown = clamp(1.5f - vec2(5.3f, 17.9f) * cells, 0.0f, 1.0f);
  return look.detail * vec2(0.55f, 0.25f) * shown;
}

/// The noise of the tile with both octaves of detail, [0, 1]. Its mean stays.
SHARED_FUNCTION vec4 with_detail(vec4 noise, vec4 fine, vec4 finer, vec2 weights) {
  return clamp(noise + weights.x * (fine - 0.5f) + weights.y * (finer - 0.5f), 0.0f, 1.0f);
}

/// Whether any detail of these weights changes what erosion leaves: not where all remains without it, or nothing.
SHARED_FUNCTION bool detail_matters(SmokeLook look, float density, vec4 noise, vec2 weights) {
  float reach = 0.5f * (weights.x + weights.y);
  return reach > 0.0f && eroded_fraction(look, density, min(noise + reach, vec4(1.0f))) > 0.0f &&
         eroded_fraction(look, density, max(noise - reach, vec4(0.0f))) < 1.0f;
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
