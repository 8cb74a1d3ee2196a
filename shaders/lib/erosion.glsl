// What makes smoke look like smoke: noise that eats into its rim.
#ifndef EROSION_GLSL
#define EROSION_GLSL
#include "shared/frame.h"

/// The noise at a point: large and small billows, bright where the smoke stays.
vec2 billows(sampler3D worley_tile, SmokeLook look, vec3 p_world, float time) {
  return textureLod(worley_tile, (p_world - vec3(0.0, look.noise_drift * time, 0.0)) / look.noise_period, 0.0).rg;
}

/// Density after the noise: the less smoke there is, the brighter the noise must be for any to stay. Full smoke stays
/// full, so that nothing is lost along walls.
float erode(SmokeLook look, float density, vec2 noise) {
  const float bright = clamp(1.7 * (0.6 * noise.r + 0.4 * noise.g) - 0.4, 0.0, 1.0);
  const float threshold = look.erosion * (1.0 - bright);
  return clamp((density - threshold) / max(1.0 - look.erosion, 0.05), 0.0, 1.0);
}

#endif
