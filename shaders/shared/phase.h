// Phase functions: how scattered light spreads over directions, in C++ and GLSL.
#ifndef BRUME_PHASE_H
#define BRUME_PHASE_H
#include "shared/shim.h"
SHARED_BEGIN

/// A blend of the phase functions of Henyey and Greenstein and of Draine.
struct Phase {
  float g_hg;           // (-1, 1); above 0: forward
  float g_draine;       // (-1, 1)
  float alpha;          // of Draine's function, >= 0; 0: equals Henyey and Greenstein
  float draine_weight;  // [0, 1]; 0: Henyey and Greenstein only
};
SHARED_SIZE(Phase, 16);

/// Range of droplet diameters of phase_of_droplet [micrometres].
SHARED_CONST float kSmallestDroplet = 0.1f;
SHARED_CONST float kLargestDroplet = 50.0f;

/// Henyey and Greenstein 1941 [1/sr]; cos_angle between the light's directions before and after scattering. The
/// denominator 1 + g^2 - 2 g cos_angle is written without cancellation in the peak, where it is small.
SHARED_FUNCTION float henyey_greenstein(float g, float cos_angle) {
  float size = abs(g), towards_peak = g < 0.0f ? -cos_angle : cos_angle;
  float d = (1.0f - size) * (1.0f - size) + 2.0f * size * (1.0f - towards_peak);
  return 0.0795774715f * (1.0f - size) * (1.0f + size) / (d * sqrt(d));
}

/// Draine 2003, "Scattering by Interstellar Dust Grains. I. Optical and Ultraviolet" [1/sr].
SHARED_FUNCTION float draine(float g, float alpha, float cos_angle) {
  float tint = (1.0f + alpha * cos_angle * cos_angle) / (1.0f + alpha * (1.0f + 2.0f * g * g) * (1.0f / 3.0f));
  return henyey_greenstein(g, cos_angle) * tint;
}

/// Scattered fraction per solid angle [1/sr]; integrates to 1 over all directions.
SHARED_FUNCTION float phase_value(Phase phase, float cos_angle) {
  float value = henyey_greenstein(phase.g_hg, cos_angle);
  if (phase.draine_weight > 0.0f) {
    value = mix(value, draine(phase.g_draine, phase.alpha, cos_angle), phase.draine_weight);
  }
  return value;
}

/// Mean cosine of the scattering angle; Draine's part from his paper.
SHARED_FUNCTION float mean_cosine(Phase phase) {
  float g = phase.g_draine, g2 = g * g;
  float of_draine = g * (1.0f + phase.alpha * (3.0f + 2.0f * g2) * 0.2f) /
                    (1.0f + phase.alpha * (1.0f + 2.0f * g2) * (1.0f / 3.0f));
  return mix(phase.g_hg, of_draine, phase.draine_weight);
}

/// Blends towards isotropic scattering: the function itself at 1, isotropic at 0.
SHARED_FUNCTION Phase rounder_phase(Phase phase, float anisotropy) {
  phase.g_hg *= anisotropy;
  phase.g_draine *= anisotropy;
  phase.alpha *= anisotropy;
  return phase;
}

/// Henyey and Greenstein only; g in (-1, 1).
SHARED_FUNCTION Phase phase_of_hg(float g) {
  Phase phase;
  phase.g_hg = g;
  phase.g_draine = 0.0f;
  phase.alpha = 0.0f;
  phase.draine_weight = 0.0f;
  return phase;
}

/// Water droplets in air under visible light, diameter in [kSmallestDroplet, kLargestDroplet] micrometres: the fit to
/// Mie theory of Jendersie and d'Eon 2023, "An Approximate Mie Scattering Function for Fog and Cloud Rendering" and
/// its supplement. The three ranges do not meet exactly at 1.5 and 5 micrometres.
SHARED_FUNCTION Phase phase_of_droplet(float diameter) {
  float d = clamp(diameter, kSmallestDroplet, kLargestDroplet), l = log(d);
  Phase phase;
  if (d >= 5.0f) {
    phase.g_hg = exp(-0.0990567f / (d - 1.67154f));
    phase.g_draine = exp(-2.20679f / (d + 3.91029f) - 0.428934f);
    phase.alpha = exp(3.62489f - 8.29288f / (d + 5.52825f));
    phase.draine_weight = exp(-0.599085f / (d - 0.641583f) - 0.665888f);
  } else if (d >= 1.5f) {
    phase.g_hg = 0.0604931f * log(l) + 0.940256f;
    phase.g_draine = 0.500411f - 0.081287f / (tan(l) - 2.0f * l + 1.27551f);
    phase.alpha = 7.30354f * l + 6.31675f;
    phase.draine_weight = 0.026914f * (l - cos(5.68947f * (log(l) - 0.0292149f))) + 0.376475f;
  } else {
    float bend = cos((l - 0.238604f) * (l + 1.00667f) / (0.507522f - 0.15677f * l));
    phase.g_hg = 0.862f - 0.143f * l * l;
    phase.g_draine = 0.379685f * cos(1.19692f * bend + 1.37932f * l + 0.0625835f) + 0.344213f;
    phase.alpha = 250.0f;
    phase.draine_weight = 0.146209f * cos(3.38707f * l + 2.11193f) + 0.316072f + 0.0778917f * l;
  }
  return phase;
}

SHARED_END
#endif
