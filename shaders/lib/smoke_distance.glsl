// How far away the smoke of a pixel is, for reprojection.
#ifndef SMOKE_DISTANCE_GLSL
#define SMOKE_DISTANCE_GLSL
#include "lib/ray_bounds.glsl"

/// Distance along the view axis to the smoke of a pixel, for reprojection: the mean distance of the light that a
/// homogeneous medium between the media's bounds and the surface sends to the eye. Smoke moves slowly; its parallax is
/// that of this point, not of the surface behind.
float smoke_distance(vec3 origin, vec3 ray, float z_surface, float transmittance) {
  const vec2 inside = clip_to_media(origin, ray, z_surface);
  const float enter = inside.x, leave = inside.y;
  if (leave <= enter) return z_surface;
  // Opaque smoke is dense.
  const bool opaque = transmittance <= max(frame.media.opaque_transmittance, 1e-3);
  const float tau = opaque ? max(frame.media.extinction * (leave - enter), 7.0) : -log(transmittance);
  // The mean of a truncated exponential distribution.
  const float fraction = tau > 0.01 ? 1.0 / tau - exp(-tau) / (1.0 - exp(-tau)) : 0.5;
  return mix(enter, leave, fraction);
}

#endif
