// Which holes a ray meets.
#ifndef HOLES_GLSL
#define HOLES_GLSL
#include "shared/hole.h"

/// False only when no point of the ray between t_begin and t_end can lie in the hole: the distance between the
/// two segments (Ericson 2005, "Real-Time Collision Detection", 5.1.9) against the widest cross-section.
bool hole_near_ray(Hole hole, vec3 origin_world, vec3 direction, float t_begin, float t_end, float rim) {
  const vec3 d1 = direction * (t_end - t_begin), d2 = hole.forward * hole.distance_to_far;
  const vec3 r = origin_world + direction * t_begin - hole.origin_world;
  const float a = dot(d1, d1), e = dot(d2, d2), f = dot(d2, r), c = dot(d1, r), b = dot(d1, d2);
  const float denominator = a * e - b * b;
  float s = denominator > 1e-6 * a * e ? clamp((b * f - c * e) / denominator, 0.0, 1.0) : 0.0;
  float t = (b * s + f) / e;
  if (t < 0.0 || t > 1.0) {
    t = clamp(t, 0.0, 1.0);
    s = clamp((b * t - c) / a, 0.0, 1.0);
  }
  const vec3 apart = r + d1 * s - d2 * t;
  const float reach = 1.4143 * (hole.radius + rim);
  return dot(apart, apart) <= reach * reach;
}

#endif
