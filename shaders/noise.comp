// Fills the tile of noise that erodes smoke. Each channel covers [0, 1] uniformly and is bright where smoke remains.
//   R: large round billows on a connected base   G: small billows   B: threads, for thin smoke
//   A: broad variation, as wide as the tile allows
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/noise.glsl"
#include "shared/noise.h"

// Rows of 8: a software rasteriser takes the lanes of a subgroup from a row.
layout(local_size_x = 8, local_size_y = 8) in;
layout(binding = kBindNoiseTile, rgba8) uniform writeonly image3D tile;
layout(scalar, push_constant) uniform Push { NoiseParams params; };

void main() {
  const uvec3 texel = gl_GlobalInvocationID;
  if (any(greaterThanEqual(texel, uvec3(params.size)))) return;
  const vec3 p_tile = (vec3(texel) + 0.5) / float(params.size);
  const int cells = int(params.coarse_cells);
  // Means and deviations of the noise, measured over many seeds.
  const float billows = spread(perlin_worley(p_tile, cells, 3u, params.seed), 0.860, 0.061);
  const float detail = spread(worley_octaves(p_tile, 3 * cells, 2u, params.seed + 64u), 0.477, 0.129);
  const float wisps = spread(threads(p_tile, 2 * cells, 2u, params.seed + 128u), 0.845, 0.082);
  const float broad = spread(perlin_octaves(p_tile, max(cells / 2, 1), 2u, params.seed + 192u), 0.0, 0.143);
  imageStore(tile, ivec3(texel), vec4(billows, detail, wisps, broad));
}
