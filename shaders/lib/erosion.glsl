// What makes smoke look like smoke: noise that eats into its rim and lets billows show inside.
#ifndef EROSION_GLSL
#define EROSION_GLSL
#include "shared/frame.h"

/// The noise at a point, a channel each: large billows, small ones, threads, broad (shaders/noise.comp).
/// It rises with the smoke; a point's drift is taken into it by the caller.
vec4 smoke_noise(sampler3D noise_tile, SmokeLook look, vec3 p_world, float time) {
  return textureLod(noise_tile, (p_world - vec3(0.0, look.noise_drift * time, 0.0)) / look.noise_period, 0.0);
}

/// Density after the noise: the less smoke there is, the brighter the noise must be for any to stay; where there is
/// little, threads decide instead of billows, so that what dissolves leaves wisps. Rises with density and with each
/// channel; 0 where the density is 0. Where it is 1 the mean over the noise is 1, so that no line shows along walls, and
/// the most is 1 + 0.5 look.erosion.
float erode(SmokeLook look, float density, vec4 noise) {
  // Sums of channels crowd around their middle: spread over [0, 1] again.
  const float billows = clamp(1.6 * dot(noise, vec4(0.55, 0.22, 0.0, 0.23)) - 0.4, 0.0, 1.0);
  const float wisps = clamp(1.3 * dot(noise, vec4(0.25, 0.0, 0.75, 0.0)) - 0.1, 0.0, 1.0);
  const float threshold = look.erosion * (1.0 - mix(billows, wisps, 0.5 - 0.5 * density));
  const float left = clamp(4.0 * (density - threshold) / max(1.0 - threshold, 0.05), 0.0, 1.0);
  const float inside = 1.0 + look.erosion * (0.7 * noise.r + 0.3 * noise.g - 0.5);
  return left * inside;
}

#endif
