// How much of a light's way into smoke ends towards the eye, after one scattering and after many (docs/light.md).
#ifndef BRUME_SCATTERING_H
#define BRUME_SCATTERING_H
#include "shared/frame.h"
SHARED_BEGIN

/// What light that was scattered more than once is fitted by. It decays as diffusing light does, exp(-k depth),
/// k = decay sqrt((1 - held albedo) (1 - g albedo)), g the mean cosine of the phase function (for held = 1 and
/// decay = sqrt 3 that is the diffusion equation's, Ishimaru 1978); it grows with the chance q = albedo (1 - escape)
/// of another scattering, as share exp(-share_g g) q / (1 - closure q); and it leaves as Henyey-Greenstein with
/// g / (1 + exp(even - even_g g)), more evenly than after one scattering.
struct ManyFit {
  float decay, held, share, share_g, closure, even, even_g;
};
SHARED_SIZE(ManyFit, 28);

/// Fitted to random walks in slabs, spheres and boxes by tests/light.
SHARED_FUNCTION ManyFit many_fit() {
  ManyFit fit;
  fit.decay = 1.050f;
  fit.held = 0.951f;
  fit.share = 0.788f;
  fit.share_g = 0.481f;
  fit.closure = 0.775f;
  fit.even = 3.409f;
  fit.even_g = 4.663f;
  return fit;
}

/// Multiple scattering at a point, whatever the light: what of the fit does not depend on it.
struct ManyScatterings {
  vec3 decay;  // per optical depth to the light
  vec3 share;  // of the light's irradiance
  float g;     // how it leaves
};
SHARED_SIZE(ManyScatterings, 28);

/// `g`: the mean cosine, [0, 1); below 0 as 0. `escape`: mean over all directions of the transmittance out of the smoke.
SHARED_FUNCTION ManyScatterings multiple_scattering(ManyFit fit, vec3 albedo, float g, float escape) {
  float forward = max(g, 0.0f);
  vec3 again = albedo * (1.0f - escape);
  ManyScatterings many;
  many.decay = fit.decay * sqrt((vec3(1.0f) - fit.held * albedo) * (vec3(1.0f) - forward * albedo));
  many.share = fit.share * exp(-fit.share_g * forward) * again / (vec3(1.0f) - fit.closure * again);
  many.g = forward / (1.0f + exp(fit.even - fit.even_g * forward));
  return many;
}

/// The same for the smoke of a frame; nothing where look.multiple_scattering is 0.
SHARED_FUNCTION ManyScatterings multiple_scattering(SmokeLook look, float escape) {
  ManyScatterings many = multiple_scattering(many_fit(), look.albedo, mean_cosine(look.phase), escape);
  many.share *= look.multiple_scattering;
  return many;
}

/// Share of a light's irradiance, as it would be without smoke, that is scattered towards the eye [1/sr] per unit of
/// scattering coefficient: after one scattering, and after many. `depth`: optical depth between the light and the point;
/// `cos_angle`: between the light's way and the way to the eye.
SHARED_FUNCTION vec3 scattered(Phase phase, ManyScatterings many, float depth, float cos_angle) {
  return vec3(exp(-depth) * phase_value(phase, cos_angle)) +
         many.share * exp(-many.decay * depth) * henyey_greenstein(many.g, cos_angle);
}

SHARED_END
#endif
