// Detail below the voxels of a volume: the noise that erodes smoke, with two octaves below it, at the thin parts of any
// volume. The idea is that of "up-rezzing" by noise (Schneider 2023, "Nubis cubed", SIGGRAPH Advances in Real-Time
// Rendering).
#ifndef BRUME_VOLUME_DETAIL_H
#define BRUME_VOLUME_DETAIL_H
#include "shared/erosion.h"
#include "shared/volume.h"
SHARED_BEGIN

/// The look of smoke that is eroded as a volume is. Its other members have no meaning.
SHARED_FUNCTION SmokeLook look_of_detail(VolumeDetail detail) {
  SmokeLook look;
  look.erosion = detail.strength;
  look.detail = 1.0f;
  look.noise_frequency = detail.tiles_per_metre;
  return look;
}

/// The point of the tile of detail at a point of the tile of noise.
SHARED_FUNCTION vec3 volume_detail_point(vec3 p_tile) { return kDetailRatio * p_tile + vec3(0.31f, 0.17f, 0.73f); }

/// Weight of the tile's own noise, of whose billows a tile has 4 to 16, where a pixel is as wide as `pixel` [m].
SHARED_FUNCTION float coarse_weight(VolumeDetail detail, float pixel) {
  return clamp(1.5f - 8.0f * detail.tiles_per_metre * pixel, 0.0f, 1.0f);
}

/// Fraction that is left of a volume where its value is `value`, [0, 1], by the noise of the tile and detail of that
/// weight. Increases with the value and with the noise.
SHARED_FUNCTION float volume_fraction(VolumeDetail detail, float value, vec2 noise, vec2 fine, float weight) {
  float density = clamp(value * detail.per_value, 0.0f, 1.0f);
  return eroded_fraction(look_of_detail(detail), density, noise + weight * fine);
}

/// Its mean over the noise, for what is coarser. Noise with detail is nearly evenly distributed, over a width of 1
/// around its mean: right within 0.04, and 0.1 where strength and density are nearly 1.
SHARED_FUNCTION float mean_volume_fraction(VolumeDetail detail, float value) {
  float density = clamp(value * detail.per_value, 0.0f, 1.0f);
  float mean_noise = mix(0.468f, 0.568f, wisps_share(density));
  // rim_position is 1 at the first of these thresholds, 0 at the second. As fractions of the noise that is above them:
  vec2 thresholds = vec2((8.0f * density - 1.5f) / 6.5f, (8.0f * density - 0.5f) / 7.5f);
  vec2 above = thresholds / detail.strength + (mean_noise - 0.5f);
  float width = above.y - above.x;
  if (width < 1e-3f) return clamp(above.x, 0.0f, 1.0f);
  return (integrals_of_clamped(above.y, 0.0f, 1.0f).x - integrals_of_clamped(above.x, 0.0f, 1.0f).x) / width;
}

SHARED_END
#endif
