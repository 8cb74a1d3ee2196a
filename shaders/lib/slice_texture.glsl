// Samples of a volume from an image of slices with several volumes (shared/slice_texture.h).
#ifndef SLICE_TEXTURE_GLSL
#define SLICE_TEXTURE_GLSL
#include "export/volume_projection.glsl"
#include "shared/slice_texture.h"

/// The four channels at a point of the volume, whose box is [0, 1]^3: trilinear, clamped to the edges, 0 outside. The
/// sampler filters linearly.
vec4 slice_texture_sample(sampler2D image, SliceTexture volume, vec3 uvw) {
  const VolumeSlices slices =
      VolumeSlices(volume.tile_texels, volume.padding, volume.tile_count, volume.columns, volume.rows);
  VolumeProjection at = volume_projection(vec3(1.0), uvw - 0.5, slices);
  at.uv1 = volume.uv_first + at.uv1 * volume.uv_size;
  at.uv2 = volume.uv_first + at.uv2 * volume.uv_size;
  return volume_sample(image, at, 0.0);
}

#endif
