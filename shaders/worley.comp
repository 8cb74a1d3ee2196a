// Fills a 3D tile with inverted Worley noise (Worley 1996, "A Cellular Texture Basis Function"): bright at the
// feature points, so that thresholding it gives billows. R: large billows, G: small ones.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/hash.glsl"
#include "shared/worley.h"

layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(binding = 0, rg8) uniform writeonly image3D tile;
layout(push_constant, scalar) uniform Push { WorleyParams params; };

/// Distance to the nearest feature point in cells, over a torus of `cells` cells per axis.
float worley(vec3 p_tile, int cells, uint seed) {
  const vec3 p = p_tile * float(cells);
  const ivec3 home = ivec3(floor(p));
  float nearest = 4.0;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const ivec3 cell = home + ivec3(x, y, z);
        const ivec3 wrapped = (cell + cells) % cells;
        const vec3 apart = vec3(cell) + hash3(uvec3(wrapped) + uvec3(seed, seed * 3u, seed * 7u)) - p;
        nearest = min(nearest, dot(apart, apart));
      }
  return sqrt(nearest);
}

float billows(vec3 p_tile, int cells, uint seed) {
  float sum = 0.0, weight = 1.0, total = 0.0;
  for (uint octave = 0u; octave < params.octaves; ++octave) {
    sum += weight * clamp(1.0 - worley(p_tile, cells << octave, seed + octave), 0.0, 1.0);
    total += weight;
    weight *= 0.5;
  }
  return sum / total;
}

void main() {
  const uvec3 texel = gl_GlobalInvocationID;
  if (any(greaterThanEqual(texel, uvec3(params.size)))) return;
  const vec3 p_tile = (vec3(texel) + 0.5) / float(params.size);
  const int coarse = int(params.coarse_cells);
  imageStore(tile, ivec3(texel), vec4(billows(p_tile, coarse, params.seed), billows(p_tile, 3 * coarse, params.seed + 101u), 0.0, 0.0));
}
