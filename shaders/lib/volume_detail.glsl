// Detail below the voxels of a volume, at samples of rays from the eye. The includer defines the constant kMedia.
#ifndef VOLUME_DETAIL_GLSL
#define VOLUME_DETAIL_GLSL
#include "lib/detail_tile.glsl"
#include "lib/frame.glsl"
#include "lib/noise_tile.glsl"
#include "lib/volume_disturbance.glsl"
#include "lib/volume_transfer.glsl"
#include "shared/volume_detail.h"

/// Fraction that is left of the matter of volume i at a point of its voxel space, `t` metres from the eye.
float detail_left(uint i, vec3 p_voxel, float density, float t, inout uint texture_samples) {
  const VolumeDetail detail = volumes[i].detail;
  if (!kHasVolumeDetail || detail.strength <= 0.0 || density <= 0.0) return 1.0;
  const VolumeEffect effect = volume_effects[i];
  const float pixel = kInParallelView ? frame.pixel_width : t * frame.pixel_width;
  const SmokeLook look = look_of_detail(detail);
  const vec3 tile = p_voxel * effect.detail_per_voxel + effect.detail_offset;
  const vec2 noise = billows_and_wisps(textureLod(noise_tile, tile, 0.0));
  const vec2 fine =
      detail_of(textureLod(detail_tile, volume_detail_point(tile), detail_level(look, pixel)).rg);
  texture_samples += 2u;
  return volume_fraction(detail, density, mix(vec2(0.5), noise, coarse_weight(detail, pixel)), fine,
                         detail_weight(look, pixel));
}

#endif
