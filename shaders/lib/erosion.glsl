// Noise of the erosion (shared/erosion.h).
#ifndef EROSION_GLSL
#define EROSION_GLSL
#include "shared/erosion.h"

/// The noise at a point, a channel each: large billows, small ones, threads, broad (shaders/noise.comp).
/// It rises with the smoke; the caller adds the displacement of the noise to the point.
vec4 smoke_noise(sampler3D noise_tile, SmokeLook look, vec3 p_world, float time) {
  return textureLod(noise_tile, noise_point(look, p_world, time, 0u), 0.0);
}

/// That noise with detail of these weights.
vec4 detailed_noise(sampler3D noise_tile, SmokeLook look, vec3 p_world, float time, vec4 noise, vec2 weights,
                    inout uint texture_samples) {
  const vec4 fine = textureLod(noise_tile, noise_point(look, p_world, time, 1u), 0.0);
  ++texture_samples;
  vec4 finer = vec4(0.5);
  if (weights.y > 0.0) {
    finer = textureLod(noise_tile, noise_point(look, p_world, time, 2u), 0.0);
    ++texture_samples;
  }
  return with_detail(noise, fine, finer, weights);
}

#endif
