// How much of a light's way into smoke ends towards the eye, after one scattering and after many.
#ifndef BRUME_SCATTERING_H
#define BRUME_SCATTERING_H
#include "shared/frame.h"
SHARED_BEGIN

/// Share of a light's irradiance, as it would be without smoke, that is scattered towards the eye [1/sr] per unit of
/// scattering coefficient: the sum over octaves. `depth`: optical depth between the light and the point; `cos_angle`:
/// between the light's way and the way to the eye. Each octave sees thinner smoke, less light and a rounder phase
/// function (Wrenninge et al. 2013, "Oz: The Great and Volumetric"); look.scatter_octaves 1 is single scattering.
SHARED_FUNCTION vec3 scattered(SmokeLook look, float depth, float cos_angle) {
  float sum = 0.0f, share = 1.0f;
  for (float octave = 0.0f; octave < look.scatter_octaves; ++octave) {
    sum += share * exp(-depth * share) * phase_value(rounder_phase(look.phase, share), cos_angle);
    share *= 0.5f;
  }
  return vec3(sum);
}

SHARED_END
#endif
