// Light scattered towards the eye, once and many times (docs/how/light.md).
#ifndef BRUME_SCATTERING_H
#define BRUME_SCATTERING_H
#include "shared/frame.h"
SHARED_BEGIN

/// Parameters of the fit for light scattered more than once. It decays like diffusing light, exp(-k depth),
/// k = decay sqrt((1 - held albedo) (1 - g albedo)), g the mean cosine of the phase function (held = 1 and
/// decay = sqrt 3 give the diffusion equation, Ishimaru 1978). It grows with the probability q = albedo (1 - escape)
/// of another scattering, as scale exp(-scale_g g) q / (1 - closure q). It leaves with the Henyey-Greenstein function
/// of g / (1 + exp(even - even_g g)), more isotropic than after one scattering.
struct ManyFit {
  float decay, held, scale, scale_g, closure, even, even_g;
};
SHARED_LOCAL(ManyFit);

/// Fitted by tests/light to random walks in slabs, spheres and boxes.
SHARED_FUNCTION ManyFit many_fit() {
  ManyFit fit;
  fit.decay = 1.050f;
  fit.held = 0.951f;
  fit.scale = 0.788f;
  fit.scale_g = 0.481f;
  fit.closure = 0.775f;
  fit.even = 3.409f;
  fit.even_g = 4.663f;
  return fit;
}

/// The part of the fit at a point that does not depend on the light.
struct ManyScatterings {
  vec3 decay;     // per optical depth to the light
  vec3 fraction;  // of the light's irradiance
  float g;        // of the outgoing light
};
SHARED_LOCAL(ManyScatterings);

/// `g`: mean cosine, [0, 1); negative values count as 0. `escape`: mean transmittance out of the smoke over all
/// directions.
SHARED_FUNCTION ManyScatterings multiple_scattering(ManyFit fit, vec3 albedo, float g, float escape) {
  float forward = max(g, 0.0f);
  vec3 again = albedo * (1.0f - escape);
  ManyScatterings many;
  many.decay = fit.decay * sqrt((vec3(1.0f) - fit.held * albedo) * (vec3(1.0f) - forward * albedo));
  many.fraction = fit.scale * exp(-fit.scale_g * forward) * again / (vec3(1.0f) - fit.closure * again);
  many.g = forward / (1.0f + exp(fit.even - fit.even_g * forward));
  return many;
}

/// The same for the smoke of a frame; zero where look.multiple_scattering is 0.
SHARED_FUNCTION ManyScatterings multiple_scattering(SmokeLook look, float escape) {
  ManyScatterings many = multiple_scattering(many_fit(), look.albedo, mean_cosine(look.phase), escape);
  many.fraction *= look.multiple_scattering;
  return many;
}

/// Mean radiance over all directions under a uniform sky of radiance 1, without the level, where a fraction p of it
/// arrives directly: p^sqrt((1 - albedo) (1 - g albedo)). So it decays as diffusing light does (ManyFit), is p without
/// scattering, and 1 without absorption, whatever the density. In a half-space under a sky of radiance 1 that scatters
/// evenly it is within 0.11 of the truth, with an albedo of at most 0.9 within 0.06 (tests/light). `weight` is that of
/// multiple scattering; g: the mean cosine of the phase function.
SHARED_FUNCTION vec3 scattered_sky(vec3 albedo, float weight, float g, float p) {
  vec3 again = weight * albedo;
  return pow(vec3(max(p, 1e-30f)), sqrt((vec3(1.0f) - again) * (vec3(1.0f) - g * again)));
}

/// The same for light from around that is not uniform, of which `arrival` arrives directly, in the place of p.
SHARED_FUNCTION vec3 scattered_sky(vec3 albedo, float weight, float g, float p, vec3 arrival) {
  return scattered_sky(albedo, weight, g, p) * (arrival / max(p, 1e-30f));
}

/// The part of `scattered` that is scattered more than once.
SHARED_FUNCTION vec3 scattered_often(ManyScatterings many, float depth, float cos_angle) {
  return many.fraction * exp(-many.decay * depth) * henyey_greenstein(many.g, cos_angle);
}

/// Fraction of a light's unattenuated irradiance that is scattered towards the eye [1/sr] per unit of scattering
/// coefficient, once or more often. `depth`: optical depth between light and point; `cos_angle`: between the light's
/// direction and the direction to the eye.
SHARED_FUNCTION vec3 scattered(Phase phase, ManyScatterings many, float depth, float cos_angle) {
  return vec3(exp(-depth) * phase_value(phase, cos_angle)) + scattered_often(many, depth, cos_angle);
}

SHARED_END
#endif
