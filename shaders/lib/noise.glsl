// Noise functions of a point, a lattice and a seed. All are periodic over the unit cube: `cells` lattice cells per axis
// in [1, 1024], wrapped, so that a tile has no seam.
#ifndef NOISE_GLSL
#define NOISE_GLSL
#include "lib/hash.glsl"

/// Three values in [0, 1) of a lattice point in [-1, cells]. Seeds offset the lattice.
vec3 lattice_hash(ivec3 at, int cells, uint seed) {
  at += cells * (ivec3(lessThan(at, ivec3(0))) - ivec3(greaterThanEqual(at, ivec3(cells))));
  return hash3(uvec3(at) + seed * uvec3(0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du));
}

/// Inverted cellular noise F1 (Worley 1996, "A Cellular Texture Basis Function"): 1 at the feature points, one per
/// cell, minus the distance to the nearest in cell edges; at least 0.
float worley(vec3 p_tile, int cells, uint seed) {
  const vec3 p = fract(p_tile) * float(cells);
  const ivec3 home = min(ivec3(p), cells - 1);
  float nearest = 1.0;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        const ivec3 cell = home + ivec3(x, y, z);
        const vec3 offset = vec3(cell) + lattice_hash(cell, cells, seed) - p;
        nearest = min(nearest, dot(offset, offset));
      }
  return 1.0 - sqrt(nearest);
}

/// Gradient noise with unit gradients and quintic weights (Perlin 2002, "Improving Noise") in w, mean 0, within
/// +-0.87; its derivative by the point in cells in xyz.
vec4 perlin(vec3 p_tile, int cells, uint seed) {
  const vec3 p = fract(p_tile) * float(cells);
  const ivec3 home = min(ivec3(p), cells - 1);
  const vec3 f = p - vec3(home);
  const vec3 w = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
  const vec3 dw = 30.0 * f * f * (f - 1.0) * (f - 1.0);
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 8; ++i) {
    const ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2);
    const vec3 c = vec3(corner);
    const vec3 gradient = normalize(2.0 * lattice_hash(home + corner, cells, seed) - 1.0);
    const float ramp = dot(gradient, f - c);
    const vec3 weight = mix(1.0 - w, w, c), slope = mix(-dw, dw, c);
    sum.w += weight.x * weight.y * weight.z * ramp;
    sum.xyz += weight.x * weight.y * weight.z * gradient +
               ramp * slope * vec3(weight.y * weight.z, weight.x * weight.z, weight.x * weight.y);
  }
  return sum;
}

/// Curl of a vector potential of three gradient noises (Bridson et al. 2007, "Curl-Noise for Procedural Fluid Flow"):
/// divergence-free, per cell edge, RMS 1.2.
vec3 curl_noise(vec3 p_tile, int cells, uint seed) {
  const vec3 x = perlin(p_tile, cells, seed).xyz;
  const vec3 y = perlin(p_tile, cells, seed + 1u).xyz;
  const vec3 z = perlin(p_tile, cells, seed + 2u).xyz;
  return vec3(z.y - y.z, x.z - z.x, y.x - x.y);
}

/// Octaves of Worley noise, each with twice the cells and half the weight of the previous one. [0, 1]
float worley_octaves(vec3 p_tile, int cells, uint octaves, uint seed) {
  float sum = 0.0, weight = 1.0, total = 0.0;
  for (uint octave = 0u; octave < octaves; ++octave) {
    sum += weight * worley(p_tile, cells << octave, seed + octave);
    total += weight;
    weight *= 0.5;
  }
  return sum / total;
}

/// Octaves of gradient noise, likewise. Within +-0.87.
float perlin_octaves(vec3 p_tile, int cells, uint octaves, uint seed) {
  float sum = 0.0, weight = 1.0, total = 0.0;
  for (uint octave = 0u; octave < octaves; ++octave) {
    sum += weight * perlin(p_tile, cells << octave, seed + octave).w;
    total += weight;
    weight *= 0.5;
  }
  return sum / total;
}

/// Billows with creases: gradient noise dilated by cellular noise with rounded cones (Schneider 2016, "Real-Time
/// Volumetric Cloudscapes", GPU Pro 7). [0, 1]
float perlin_worley(vec3 p_tile, int cells, uint octaves, uint seed) {
  const float base = 0.5 + 0.5 * perlin_octaves(p_tile, cells, octaves, seed);
  const float far = 1.0 - worley_octaves(p_tile, cells, octaves, seed + 16u);
  return mix(base, 1.0, 1.0 - far * far);
}

/// Thin threads: ridged gradient noise, 1 where the noise crosses 0 (Musgrave 1994, "Texturing and Modeling"). [0, 1]
float threads(vec3 p_tile, int cells, uint octaves, uint seed) {
  float sum = 0.0, weight = 1.0, total = 0.0;
  for (uint octave = 0u; octave < octaves; ++octave) {
    sum += weight * (1.0 - abs(perlin(p_tile, cells << octave, seed + octave).w));
    total += weight;
    weight *= 0.5;
  }
  return sum / total;
}

/// Equalises values of this mean and standard deviation to about uniform in [0, 1], so that a threshold x removes a
/// fraction x. A logistic curve approximates the normal distribution.
float spread(float value, float mean, float deviation) {
  return 1.0 / (1.0 + exp(-1.702 * (value - mean) / deviation));
}

#endif
