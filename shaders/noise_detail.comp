// Fills the tile of detail of the noise that erodes smoke: two octaves of the tile of noise itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/noise_tile.glsl"
#include "shared/erosion.h"

// Rows of 8: a software rasteriser takes the lanes of a subgroup from a row.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindDetailTile, rg8) uniform writeonly image3D detail_tile;

void main() {
  const uvec3 texel = gl_GlobalInvocationID;
  if (any(greaterThanEqual(texel, uvec3(kDetailTexels)))) return;
  const vec3 p_tile = (vec3(texel) + 0.5) / float(kDetailTexels);
  const vec4 large = textureLod(noise_tile, p_tile, 0.0), small = textureLod(noise_tile, finer_point(p_tile), 0.0);
  imageStore(detail_tile, ivec3(texel), vec4(detail_texel(large, small), 0.0, 0.0));
}
