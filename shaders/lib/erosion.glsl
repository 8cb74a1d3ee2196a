// Noise of the erosion (shared/erosion.h).
#ifndef EROSION_GLSL
#define EROSION_GLSL
#include "shared/erosion.h"

/// The noise at a point, a channel each: large billows, small ones, threads, broad (shaders/noise.comp).
/// It rises with the smoke; the caller adds the displacement of the noise to the point.
vec4 smoke_noise(sampler3D noise_tile, SmokeLook look, vec3 p_world, float time) {
  return textureLod(noise_tile, noise_point(look, p_world, time), 0.0);
}

#endif
