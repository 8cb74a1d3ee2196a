// What a ray that was marched to two depths says of the smoke in front of a third.
#ifndef UPSAMPLE_GLSL
#define UPSAMPLE_GLSL
#include "lib/camera.glsl"
#include "shared/frame.h"
#include "shared/resolve.h"

/// Distance along the view axis to a surface from its reverse depth, moved to the smoke's bounds where it lies in
/// front of them or behind: all the same for the smoke.
float distance_in_smoke(FrameConstants frame, float depth) {
  const vec3 middle = 0.5 * (frame.volume.bounds_min + frame.volume.bounds_max) * frame.volume.voxel_size;
  const vec3 half_size = 0.5 * (frame.volume.bounds_max - frame.volume.bounds_min) * frame.volume.voxel_size;
  const float along = dot(frame.volume.origin_world + middle - frame.camera.eye_world, frame.camera.forward);
  const float reach = dot(abs(frame.camera.forward), half_size);
  return clamp(view_distance(frame.camera, depth), max(along - reach, 0.0), max(along + reach, 0.0));
}

struct Estimate {
  vec4 smoke;   // premultiplied radiance, transmittance
  float doubt;  // how much the transmittance may be off
};

/// The smoke between the eye and a surface at distance z, from what a ray saw up to e.near and to e.far. Between them
/// the density is taken to be even, which in an even medium is exact. What it can be off follows from density 1 being
/// the most there is.
Estimate at_distance(RayEnds e, vec4 near, vec4 far, float z, SmokeLook look, float voxel_size) {
  Estimate result;
  const float sigma = look.extinction;
  if (z <= e.near) {
    result.smoke = near;
    result.doubt = min(1.0 - near.a, near.a * (exp(min(sigma * (e.near - z), 20.0)) - 1.0));
    return result;
  }
  if (z >= e.far) {
    result.smoke = far;
    result.doubt = far.a * (1.0 - exp(-sigma * (z - e.far)));
    return result;
  }
  // Even density: the transmittance falls exponentially, and radiance grows as it falls.
  const float span = e.far - e.near, share = (z - e.near) / span;
  const float ratio = max(far.a, 1e-3) / max(near.a, 1e-3);
  const float fallen = ratio < 0.999 ? (1.0 - pow(ratio, share)) / (1.0 - ratio) : share;
  result.smoke = mix(near, far, fallen);
  const float least = max(far.a, near.a * exp(-sigma * (z - e.near)));
  const float most = min(near.a, max(far.a, look.opaque_transmittance) * exp(min(sigma * (e.far - z), 20.0)));
  result.doubt = max(most - least, 0.0) * min(span / voxel_size, 1.0);
  return result;
}

#endif
