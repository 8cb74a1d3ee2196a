// A volume among several in one image of slices (passes/slice_textures.hpp).
#ifndef BRUME_SLICE_TEXTURE_H
#define BRUME_SLICE_TEXTURE_H
#include "shared/shim.h"
SHARED_BEGIN

SHARED_BINDING(kBindSliceTextures, 55u);

/// The first six are VolumeSlices of export/volume_projection.glsl: whole numbers. The uv that it gives, in an image of
/// this volume alone, is at uv_first + uv * uv_size in the image of all.
struct SliceTexture {
  vec2 tile_texels;  // size of a tile without its padding
  float padding;     // texels around each tile
  float tile_count;
  float columns;
  float rows;
  vec2 uv_first;
  vec2 uv_size;
};
SHARED_SIZE(SliceTexture, 40);

SHARED_END
#endif
