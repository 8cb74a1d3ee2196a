// Erosion of smoke by noise: wisps at its rim, billows inside.
#ifndef BRUME_EROSION_H
#define BRUME_EROSION_H
#include "shared/frame.h"
#include "shared/noise.h"
SHARED_BEGIN

/// A texel's noise as thresholds take it: billows and wisps. A sum of channels concentrates around its mean and is
/// stretched: beyond [0, 1] it counts as on it.
SHARED_FUNCTION vec2 billows_and_wisps(vec4 noise) {
  return vec2(1.35f * dot(noise, vec4(0.65f, 0.1f, 0.0f, 0.25f)) - 0.235f,
              1.3f * dot(noise, vec4(0.25f, 0.0f, 0.75f, 0.0f)) - 0.1f);
}

/// How much wisps count beside billows: in very thin smoke as much, so dissolving smoke turns into threads.
SHARED_FUNCTION float wisps_share(float density) {
  float thin = (1.0f - density) * (1.0f - density);
  return 0.5f * thin * thin;
}

/// What noise removes: density below it, [0, look.erosion]. The thinner the smoke, the brighter the noise must be for
/// any to remain.
SHARED_FUNCTION float erosion_threshold(SmokeLook look, float density, vec2 noise) {
  vec2 limited = clamp(noise, 0.0f, 1.0f);
  return look.erosion * (1.0f - mix(limited.x, limited.y, wisps_share(density)));
}

/// A threshold with detail of that weight, from the one without. That of the sum of both noises where neither is beyond
/// [0, 1]; else it may differ, and needs two registers less.
SHARED_FUNCTION float threshold_with(SmokeLook look, float density, float threshold, vec2 detail, float weight) {
  float higher = look.erosion * weight * mix(detail.x, detail.y, wisps_share(density));
  return clamp(threshold - higher, 0.0f, look.erosion);
}

/// Where a density is in the rim: what erosion leaves of it, before it is limited to [0, 1].
SHARED_FUNCTION float rim_position(SmokeLook look, float density, float threshold) {
  // With detail the rim is up to twice as steep, around the same middle.
  float above = 4.0f * (density - threshold) / max(1.0f - threshold, 0.05f);
  return above + look.detail * (above - 0.5f);
}

/// Fraction of a density that erosion leaves. Increases with density and with the noise; 0 where the density is 0.
SHARED_FUNCTION float eroded_fraction(SmokeLook look, float density, vec2 noise) {
  return clamp(rim_position(look, density, erosion_threshold(look, density, noise)), 0.0f, 1.0f);
}

/// What a density becomes where erosion leaves all of it. Its mean over the noise is 1, its maximum
/// 1 + 0.5 look.erosion.
SHARED_FUNCTION float density_inside(SmokeLook look, vec4 noise) {
  return 1.0f + look.erosion * (0.7f * noise.r + 0.3f * noise.g - 0.5f);
}

/// Density after erosion by the noise of the tile and by `detail`, of that weight. At density 1 the mean over the noise
/// is 1, so that no line shows along walls, and the maximum is 1 + 0.5 look.erosion.
SHARED_FUNCTION float erode(SmokeLook look, float density, vec4 noise, vec2 detail, float weight) {
  return eroded_fraction(look, density, billows_and_wisps(noise) + weight * detail) * density_inside(look, noise);
}

// Detail: two octaves below the noise of the tile, which are the same tile, smaller. Both are in a tile of their own:
// billows on the large ones, and creases on those. It rises faster than the tile, so that billows roll.

/// The point of the tile of noise at `p_world`, which is displaced.
SHARED_FUNCTION vec3 noise_point(SmokeLook look, vec3 p_world, float time) {
  return (p_world - vec3(0.0f, look.rise * time, 0.0f)) * look.noise_frequency;
}

/// How much smaller than the tile of noise its detail is, and how much finer one octave than the other: a whole number,
/// as both are in one tile.
SHARED_CONST float kDetailRatio = 5.3f;
SHARED_CONST float kFinerRatio = 3.0f;
/// The point of the tile of detail at `p_world`.
SHARED_FUNCTION vec3 detail_point(SmokeLook look, vec3 p_world, float time) {
  // No ratio of small numbers, so that the lattices of the tiles do not meet.
  return kDetailRatio * noise_point(look, p_world - vec3(0.0f, 0.25f * look.rise * time, 0.0f), time) +
         vec3(0.31f, 0.17f, 0.73f);
}
/// The point of the tile of noise that is the finer octave at a point of the tile of detail.
SHARED_FUNCTION vec3 finer_point(vec3 p_tile) { return kFinerRatio * p_tile + vec3(0.61f, 0.37f, 0.13f); }

/// The least and the greatest detail of billows or wisps is this far from 0, its mean.
SHARED_CONST float kMostDetail = 0.54f;
/// A texel of the tile of detail, from the tile of noise at both points. [0, 1]
SHARED_FUNCTION vec2 detail_texel(vec4 large, vec4 small) {
  vec4 both = 0.55f * (large - 0.5f) + 0.25f * (small - 0.5f);
  return 0.5f + 0.5f / kMostDetail * (billows_and_wisps(both) - billows_and_wisps(vec4(0.0f)));
}
/// The detail of a texel of the tile.
SHARED_FUNCTION vec2 detail_of(vec2 texel) { return kMostDetail * (2.0f * texel - 1.0f); }

/// Weight of detail where a pixel is as wide as `pixel` [m]: it fades out as its billows, of which a tile has 16,
/// become narrower than that.
SHARED_FUNCTION float detail_weight(SmokeLook look, float pixel) {
  return look.detail * clamp(1.5f - 16.0f * kDetailRatio * look.noise_frequency * pixel, 0.0f, 1.0f);
}
/// The mip level whose texels are as wide as the pixel: creases fade out before billows do.
SHARED_FUNCTION float detail_level(SmokeLook look, float pixel) {
  return log2(max(float(kDetailTexels) * kDetailRatio * look.noise_frequency * pixel, 1.0f));
}

/// Whether any detail of this weight changes what erosion leaves above a threshold without it: not where all remains,
/// or nothing.
SHARED_FUNCTION bool detail_matters(SmokeLook look, float density, float threshold, float weight) {
  float reach = kMostDetail * weight * look.erosion, steep = 4.0f * (1.0f + look.detail);
  float low = max(threshold - reach, 0.0f), high = min(threshold + reach, look.erosion);
  // rim_position(low) > 0 and rim_position(high) < 1, without a division.
  return reach > 0.0f && steep * (density - low) > 0.5f * look.detail * max(1.0f - low, 0.05f) &&
         steep * (density - high) < (1.0f + 0.5f * look.detail) * max(1.0f - high, 0.05f);
}

/// The noise of the rims of holes, [-1, 1].
SHARED_FUNCTION float rim_noise(vec4 noise, vec2 detail, float weight) {
  return clamp(2.0f * noise.g - 1.0f + 1.5f * weight * detail.x, -1.0f, 1.0f);
}

/// The path along which detail casts shadows [m]: a tenth of its tile, one and a half billows.
SHARED_FUNCTION float relief_path(SmokeLook look) { return 0.1f / (kDetailRatio * look.noise_frequency); }

/// The integrals of x and of its square, x = clamp(y, low, high), over y.
SHARED_FUNCTION vec2 integrals_of_clamped(float y, float low, float high) {
  float x = clamp(y, low, high), before = min(y, low), beyond = max(y - high, 0.0f);
  return vec2(low * before + 0.5f * x * x + high * beyond,
              low * low * before + x * x * x / 3.0f + high * high * beyond);
}

/// The fraction that lets as much light through as eroded_fraction does on average over detail of full weight, for
/// what is coarser than detail. What detail does to a threshold is taken as evenly distributed, with the deviation of
/// the sum of its channels; the fractions that follow as nothing or one value, of the same mean and variance, the same
/// along two paths of detail.
SHARED_FUNCTION float effective_fraction(SmokeLook look, float density, vec2 noise) {
  // Where in the rim the density is before the threshold is limited, and where the limits are.
  float threshold = look.erosion * (1.0f - mix(noise.x, noise.y, wisps_share(density)));
  float limited = erosion_threshold(look, density, noise);
  float steep = 4.0f * (1.0f + look.detail) / max(1.0f - limited, 0.05f);
  float middle = rim_position(look, density, limited);
  float low = clamp(rim_position(look, density, look.erosion), 0.0f, 1.0f);
  float high = clamp(rim_position(look, density, 0.0f), low, 1.0f);
  float reach = 0.287f * look.detail * look.erosion * steep;
  if (reach < 1e-3f) return clamp(middle, 0.0f, 1.0f);
  middle -= steep * (threshold - clamp(threshold, 0.0f, look.erosion));
  vec2 moments = (integrals_of_clamped(middle + reach, low, high) - integrals_of_clamped(middle - reach, low, high)) /
                 (2.0f * reach);
  float mean = clamp(moments.x, low, high), depth = 2.0f * look.extinction * relief_path(look);
  // To the first order where rounding would exceed it.
  if (mean < 1e-4f || depth < 1e-2f) return mean;
  float value = clamp(moments.y / mean, mean, 1.0f), share = mean / value;
  return min(-log(max(1.0f - share * (1.0f - exp(-depth * value)), 1e-30f)) / depth, mean);
}
/// Density after erosion, likewise.
SHARED_FUNCTION float effective_erode(SmokeLook look, float density, vec4 noise) {
  return effective_fraction(look, density, billows_and_wisps(noise)) * density_inside(look, noise);
}

/// As effective_fraction, but rougher and cheaper, at a threshold without detail: what samples of rays from the eye are
/// compared with. Thresholds with detail are taken as evenly distributed, the rim as straight.
SHARED_FUNCTION float mean_fraction(SmokeLook look, float density, float threshold) {
  // Half remains at this threshold, none or all as far from it as detail and the rim reach.
  float half_left = (8.0f * density - 1.0f) / 7.0f;
  float reach = 0.287f * look.detail * look.erosion + 0.08f / (1.0f + look.detail) * (1.0f - half_left);
  float mean = clamp(0.5f + 0.5f * (half_left - threshold) / reach, 0.0f, 1.0f);
  // Thresholds are limited.
  float most = clamp(rim_position(look, density, 0.0f), 0.0f, 1.0f);
  float least = clamp(rim_position(look, density, look.erosion), 0.0f, 1.0f);
  mean = max(most * mean, least);
  // Less density lets as much light through: right to the second order, and never below 0.
  return mean / (1.0f + look.extinction * relief_path(look) * (1.0f - mean));
}

/// What detail does to the light of a sample of smoke, of which erosion leaves `left`, in terms of what it leaves
/// half-way along the path to where most light comes from: the factor is relief(look, terms, that). `mean`: the
/// mean_fraction; `fraction`: of the light that comes along the path, at this cosine to the ray from the eye. The less
/// the path to the light differs from that to the eye, the fewer of the points that are seen lie in shadow. The rest of
/// the light comes from all around, more of it from there than from elsewhere, and has gone around what is dense: its
/// mean stays. The less smoke absorbs, the less it differs from place to place.
SHARED_FUNCTION vec2 relief_terms(SmokeLook look, float left, float mean, float fraction, float cosine) {
  float alike = 0.6f;  // correlation of detail half a path apart
  float absorbed = 1.0f - max(look.albedo.x, max(look.albedo.y, look.albedo.z));
  float around = (1.0f - fraction) * clamp(4.0f * absorbed, 0.0f, 0.5f);
  float both = fraction * (0.5f + 0.5f * cosine) + around;
  return vec2(both * mean + alike * around * (left - mean), both);
}
SHARED_FUNCTION float relief(SmokeLook look, vec2 terms, float there) {
  return exp(look.extinction * relief_path(look) * (terms.x - terms.y * there));
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
