// How the light of a spot falls off towards the rim of its cone.
#ifndef BRUME_SPOT_H
#define BRUME_SPOT_H
#include "shared/light.h"
SHARED_BEGIN

/// Fraction of a spot's intensity at an angle from its axis: 1 within the inner cone, 0 outside the outer one, and the
/// square of a ramp in the cosine between them. The formula that glTF recommends (KHR_lights_punctual, "Inner and Outer
/// Cone Angles").
SHARED_FUNCTION float spot_falloff(float cos_inner, float cos_outer, float cos_angle) {
  float ramp = clamp((cos_angle - cos_outer) / max(cos_inner - cos_outer, 0.001f), 0.0f, 1.0f);
  return ramp * ramp;
}

SHARED_END
#endif
