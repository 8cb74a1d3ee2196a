// Noise functions of a point, a lattice and a seed, the same in C++ and in GLSL. All are periodic over the unit cube:
// `cells` lattice cells per axis in [1, 1024], wrapped, so that a tile has no seam.
#ifndef BRUME_NOISE_FUNCTIONS_H
#define BRUME_NOISE_FUNCTIONS_H
#include "shared/hash.h"
#include "shared/noise.h"
SHARED_BEGIN

/// Three values in [0, 1) of a lattice point in [-1, cells]. Seeds offset the lattice.
SHARED_FUNCTION vec3 lattice_hash(ivec3 at, int cells, uint seed) {
  at += cells * (ivec3(lessThan(at, ivec3(0))) - ivec3(greaterThanEqual(at, ivec3(cells))));
  return hash3(uvec3(at) + seed * uvec3(0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du));
}

/// Inverted cellular noise F1 (Worley 1996, "A Cellular Texture Basis Function"): 1 at the feature points, one per
/// cell, minus the distance to the nearest in cell edges; at least 0.
SHARED_FUNCTION float worley(vec3 p_tile, int cells, uint seed) {
  const vec3 p = fract(p_tile) * float(cells);
  const ivec3 home = min(ivec3(p), cells - 1);
  float nearest = 1.0f;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const ivec3 cell = home + ivec3(x, y, z);
        const vec3 offset = vec3(cell) + lattice_hash(cell, cells, seed) - p;
        nearest = min(nearest, dot(offset, offset));
      }
  return 1.0f - sqrt(nearest);
}

/// Gradient noise with unit gradients and quintic weights (Perlin 2002, "Improving Noise") in w, mean 0, within
/// +-0.87; its derivative by the point in cells in xyz.
SHARED_FUNCTION vec4 perlin(vec3 p_tile, int cells, uint seed) {
  const vec3 p = fract(p_tile) * float(cells);
  const ivec3 home = min(ivec3(p), cells - 1);
  const vec3 f = p - vec3(home);
  const vec3 w = f * f * f * (f * (f * 6.0f - 15.0f) + 10.0f);
  const vec3 dw = 30.0f * f * f * (f - 1.0f) * (f - 1.0f);
  vec3 derivative = vec3(0.0f);
  float value = 0.0f;
  for (int i = 0; i < 8; ++i) {
    const ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2);
    const vec3 c = vec3(corner);
    const vec3 gradient = normalize(2.0f * lattice_hash(home + corner, cells, seed) - 1.0f);
    const float ramp = dot(gradient, f - c);
    const vec3 weight = mix(1.0f - w, w, c), slope = mix(-dw, dw, c);
    value += weight.x * weight.y * weight.z * ramp;
    derivative += weight.x * weight.y * weight.z * gradient +
                  ramp * slope * vec3(weight.y * weight.z, weight.x * weight.z, weight.x * weight.y);
  }
  return vec4(derivative, value);
}

/// Curl of a vector potential of three gradient noises (Bridson et al. 2007, "Curl-Noise for Procedural Fluid Flow"):
/// divergence-free, per cell edge, RMS 1.2.
SHARED_FUNCTION vec3 curl_noise(vec3 p_tile, int cells, uint seed) {
  const vec3 x = vec3(perlin(p_tile, cells, seed));
  const vec3 y = vec3(perlin(p_tile, cells, seed + 1u));
  const vec3 z = vec3(perlin(p_tile, cells, seed + 2u));
  return vec3(z.y - y.z, x.z - z.x, y.x - x.y);
}

/// Octaves of Worley noise, each with twice the cells and half the weight of the previous one. [0, 1]
SHARED_FUNCTION float worley_octaves(vec3 p_tile, int cells, uint octaves, uint seed) {
  float sum = 0.0f, weight = 1.0f, total = 0.0f;
  for (uint octave = 0u; octave < octaves; ++octave) {
    sum += weight * worley(p_tile, cells << octave, seed + octave);
    total += weight;
    weight *= 0.5f;
  }
  return sum / total;
}

/// Octaves of gradient noise, likewise. Within +-0.87.
SHARED_FUNCTION float perlin_octaves(vec3 p_tile, int cells, uint octaves, uint seed) {
  float sum = 0.0f, weight = 1.0f, total = 0.0f;
  for (uint octave = 0u; octave < octaves; ++octave) {
    sum += weight * perlin(p_tile, cells << octave, seed + octave).w;
    total += weight;
    weight *= 0.5f;
  }
  return sum / total;
}

/// Billows with creases: gradient noise dilated by cellular noise with rounded cones (Schneider 2016, "Real-Time
/// Volumetric Cloudscapes", GPU Pro 7). [0, 1]
SHARED_FUNCTION float perlin_worley(vec3 p_tile, int cells, uint octaves, uint seed) {
  const float base = 0.5f + 0.5f * perlin_octaves(p_tile, cells, octaves, seed);
  const float far = 1.0f - worley_octaves(p_tile, cells, octaves, seed + 16u);
  return mix(base, 1.0f, 1.0f - far * far);
}

/// Thin threads: ridged gradient noise, 1 where the noise crosses 0 (Musgrave 1994, "Texturing and Modeling"). [0, 1]
SHARED_FUNCTION float threads(vec3 p_tile, int cells, uint octaves, uint seed) {
  float sum = 0.0f, weight = 1.0f, total = 0.0f;
  for (uint octave = 0u; octave < octaves; ++octave) {
    sum += weight * (1.0f - abs(perlin(p_tile, cells << octave, seed + octave).w));
    total += weight;
    weight *= 0.5f;
  }
  return sum / total;
}

/// Equalises values of this mean and standard deviation to about uniform in [0, 1], so that a threshold x removes a
/// fraction x. A logistic curve approximates the normal distribution.
SHARED_FUNCTION float spread(float value, float mean, float deviation) {
  return 1.0f / (1.0f + portable_exp(-1.702f * (value - mean) / deviation));
}

/// A texel of the tile of noise that erodes smoke. Each channel covers [0, 1] uniformly and is bright where smoke
/// remains.
///   R: large round billows on a connected base   G: small billows   B: threads, for thin smoke
///   A: broad variation, as wide as the tile allows
SHARED_FUNCTION vec4 smoke_noise_texel(NoiseParams params, uvec3 texel) {
  const vec3 p_tile = (vec3(texel) + 0.5f) / float(params.size);
  const int cells = int(params.coarse_cells);
  // Means and deviations of the noise, measured over many seeds.
  const float billows = spread(perlin_worley(p_tile, cells, 3u, params.seed), 0.860f, 0.061f);
  const float detail = spread(worley_octaves(p_tile, 3 * cells, 2u, params.seed + 64u), 0.477f, 0.129f);
  const float wisps = spread(threads(p_tile, 2 * cells, 2u, params.seed + 128u), 0.845f, 0.082f);
  const float broad = spread(perlin_octaves(p_tile, max(cells / 2, 1), 2u, params.seed + 192u), 0.0f, 0.143f);
  return vec4(billows, detail, wisps, broad);
}

SHARED_END
#endif
