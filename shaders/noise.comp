// Fills the tile of noise that erodes smoke.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/noise_functions.h"

// Rows of 8: a software rasteriser takes the lanes of a subgroup from a row.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindNoiseTile, rgba8) uniform writeonly image3D tile;
layout(scalar, push_constant) uniform Push { NoiseParams params; };

void main() {
  const uvec3 texel = gl_GlobalInvocationID;
  if (any(greaterThanEqual(texel, uvec3(params.size)))) return;
  imageStore(tile, ivec3(texel), smoke_noise_texel(params, texel));
}
