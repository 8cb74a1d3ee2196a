// Conservative tests of boxes and bundles of rays against the bounds of a hole.
#ifndef HOLE_REACH_GLSL
#define HOLE_REACH_GLSL
#include "shared/hole_reach.h"

/// False only when no point of the cube low .. low + size lies in the hole: its axis misses the cube grown by the
/// radius or the ball around the cube grown by it.
bool hole_reaches_box(HoleReach reach, vec3 low_world, float size) {
  const vec3 inverse = 1.0 / (reach.forward + vec3(lessThan(abs(reach.forward), vec3(1e-9))) * 1e-9);
  const vec3 t0 = (low_world - reach.radius - reach.from_world) * inverse;
  const vec3 t1 = (low_world + size + reach.radius - reach.from_world) * inverse;
  const vec3 first = min(t0, t1), last = max(t0, t1);
  const float enter = max(max(first.x, first.y), max(first.z, 0.0));
  if (enter > min(min(last.x, last.y), min(last.z, reach.length_m))) return false;
  const vec3 centre = low_world + 0.5 * size - reach.from_world;
  const vec3 from_axis = centre - clamp(dot(centre, reach.forward), 0.0, reach.length_m) * reach.forward;
  const float ball = reach.radius + 0.8661 * size;
  return dot(from_axis, from_axis) <= ball * ball;
}

/// Rays around an axis, up to a length: they start within `radius` of its origin and deviate from it by a limited
/// angle.
struct RayCone {
  vec3 origin_world, axis;
  float radius;
  float spread;  // tangent of the angle
  float length_m;
};

/// False only when no ray of the cone meets the hole.
///
/// With the lines of axis and hole closest at t0, d apart, a point t along the axis is sqrt(d^2 + (t - t0)^2 sin^2)
/// from the hole's line, and the cone is spread t wide there. The width exceeds the distance by at most
/// spread t0 - d sqrt(1 - spread^2 / sin^2).
bool cone_meets_hole(RayCone cone, HoleReach reach) {
  const float radius = reach.radius + cone.radius;
  const vec3 offset = cone.origin_world - reach.from_world;
  const float b = dot(cone.axis, reach.forward), c = dot(cone.axis, offset), f = dot(reach.forward, offset);
  const float sine2 = max(1.0 - b * b, 0.0), spread2 = cone.spread * cone.spread;
  if (sine2 > 4.0 * spread2 && sine2 > 1e-4) {
    const float t = (b * f - c) / sine2;
    const float d = abs(dot(offset, cross(cone.axis, reach.forward))) * inversesqrt(sine2);
    if (d * sqrt(1.0 - spread2 / sine2) > radius + cone.spread * t + 1e-3) return false;
  }
  // Closest points of the two segments (Ericson 2005, "Real-Time Collision Detection", 5.1.9).
  float s = sine2 > 1e-6 ? clamp((b * f - c) / sine2, 0.0, cone.length_m) : 0.0;
  const float t = clamp(b * s + f, 0.0, reach.length_m);
  s = clamp(b * t - c, 0.0, cone.length_m);
  const vec3 between = offset + s * cone.axis - t * reach.forward;
  const float most = radius + cone.spread * cone.length_m;
  return dot(between, between) <= most * most;
}

/// Intersects an interval of u with slope u >= bound.
void keep_above(float slope, float bound, inout vec2 interval) {
  if (slope > 1e-6) interval.x = max(interval.x, bound / slope);
  else if (slope < -1e-6) interval.y = min(interval.y, bound / slope);
  else if (bound > 0.0) interval.y = -1.0;
}

/// Distances from the cone's origin between which its rays may meet the hole; x > y: nowhere.
///
/// A point u along the axis is sqrt(A v^2 + 2 B v + C) from the hole's line, v = u - u0 from the closest point. A ray
/// there is at most spread u closer, and the hole extends by its radius.
vec2 cone_in_hole(RayCone cone, HoleReach reach) {
  const vec3 offset = cone.origin_world - reach.from_world;
  const float along = dot(cone.axis, reach.forward), behind = dot(offset, reach.forward);
  const vec3 across = cone.axis - along * reach.forward;
  const float a = dot(across, across), a_cone = a - cone.spread * cone.spread;
  vec2 interval = vec2(0.0, cone.length_m);
  if (a_cone > 1e-4) {
    const vec3 from_line = offset - behind * reach.forward;
    const float nearest = -dot(across, from_line) / a;
    const vec3 least = from_line + nearest * across;
    const float radius = max(reach.radius + cone.radius + cone.spread * nearest + 1e-3, 0.0);
    const float b = dot(across, least) - radius * cone.spread, c = dot(least, least) - radius * radius;
    const float root2 = b * b - a_cone * c;
    if (root2 <= 0.0) return vec2(0.0, -1.0);
    interval.x = max(interval.x, nearest + (-b - sqrt(root2)) / a_cone);
    interval.y = min(interval.y, nearest + (-b + sqrt(root2)) / a_cone);
  } else if (!cone_meets_hole(cone, reach)) {
    return vec2(0.0, -1.0);
  }
  keep_above(along + cone.spread, -behind - cone.radius - 1e-3, interval);
  keep_above(cone.spread - along, behind - reach.length_m - cone.radius - 1e-3, interval);
  // A ray at the cone's rim is longer than its projection on the axis.
  return vec2(interval.x, interval.y * sqrt(1.0 + cone.spread * cone.spread));
}

#endif
