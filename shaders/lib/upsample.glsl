// Smoke in front of a depth, estimated from a ray that was marched to two depths.
#ifndef UPSAMPLE_GLSL
#define UPSAMPLE_GLSL
#include "lib/camera.glsl"
#include "shared/frame.h"
#include "shared/opaque.h"
#include "shared/resolve.h"

/// Distance along the view axis to a surface from its reverse depth, clamped to the depth range of the media's
/// bounds.
float distance_in_smoke(FrameConstants frame, float depth) {
  const FrameMedia media = frame.media;
  const vec3 middle = 0.5 * (media.bounds_min + media.bounds_max);
  const vec3 half_size = 0.5 * (media.bounds_max - media.bounds_min);
  const float along = dot(middle - frame.camera.eye_world, frame.camera.forward);
  const float reach = dot(abs(frame.camera.forward), half_size);
  return clamp(view_distance(frame.camera, depth), max(along - reach, 0.0), max(along + reach, 0.0));
}

struct Estimate {
  vec4 smoke;   // premultiplied radiance, transmittance
  float doubt;  // uncertainty of the transmittance
};

/// The transmittance with which a ray usually ends. Rays that go on, because what is behind is bright or because the
/// file is graded later, are estimated like the others, so that the same tiles are marched pixel by pixel.
float usually_cut(FrameMedia media, float transmittance) {
  return media.opaque_transmittance > 0.0 && transmittance < kUsualOpaque ? 0.0 : transmittance;
}

/// The smoke between the eye and a surface at distance z, from the results of a ray up to e.near and up to e.far.
/// Assumes constant density between them. The uncertainty follows from the upper limit 1 of the density.
Estimate at_distance(RayEnds e, vec4 near, vec4 far, float z, FrameMedia media) {
  Estimate result;
  const float sigma = media.extinction;
  if (z <= e.near) {
    result.smoke = near;
    const float near_a = usually_cut(media, near.a);
    result.doubt = min(1.0 - near_a, near_a * (exp(min(sigma * (e.near - z), 20.0)) - 1.0));
    return result;
  }
  if (z >= e.far) {
    result.smoke = far;
    result.doubt = usually_cut(media, far.a) * (1.0 - exp(-sigma * (z - e.far)));
    return result;
  }
  // Constant density: the transmittance falls exponentially, and the radiance grows as it falls.
  const float span = e.far - e.near, x = (z - e.near) / span;
  const float near_a = usually_cut(media, near.a), far_a = usually_cut(media, far.a);
  const float ratio = max(far_a, 1e-3) / max(near_a, 1e-3);
  const float fallen = ratio < 0.999 ? (1.0 - pow(ratio, x)) / (1.0 - ratio) : x;
  result.smoke = mix(near, far, fallen);
  const float cut = media.opaque_transmittance > 0.0 ? kUsualOpaque : 0.0;
  const float least = max(far_a, near_a * exp(-sigma * (z - e.near)));
  const float most = min(near_a, max(far_a, cut) * exp(min(sigma * (e.far - z), 20.0)));
  result.doubt = max(most - least, 0.0) * min(span / media.smooth_length, 1.0);
  return result;
}

#endif
