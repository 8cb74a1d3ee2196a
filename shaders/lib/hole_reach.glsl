// How far a hole reaches at a time, and who may meet it: never less than where it takes anything away.
#ifndef HOLE_REACH_GLSL
#define HOLE_REACH_GLSL
#include "shared/hole.h"

/// The open part of a hole's axis, and how far from it the hole reaches.
struct HoleReach {
  vec3 from_world;
  vec3 forward;
  float length_m;
  float radius;
  bool open;
};

HoleReach hole_reach(Hole hole, float time, float rim) {
  // Open where the front has been and the hole is not closed again: 0 < age - per_metre z < life.
  const float age = time - hole.time_start;
  const float per_metre = hole.time_to_reach_far / max(hole.distance_to_far, 1e-6);
  const float life = max(hole.time_to_expand, 1e-6) + hole.time_to_stay_open + max(hole.time_to_fade, 1e-6);
  const float slack = 1e-4;  // [s], for rounding
  float near = 0.0, far = hole.distance_to_far;
  if (per_metre > 1e-9) {
    near = max(near, (age - life - slack) / per_metre);
    far = min(far, (age + slack) / per_metre);
  }
  HoleReach reach;
  reach.open = age > 0.0 && near < far && (per_metre > 1e-9 || age < life + slack);
  reach.from_world = hole.origin_world + near * hole.forward;
  reach.forward = hole.forward;
  reach.length_m = far - near;
  const float corner = hole.shape == kHoleCylinder ? 1.0 : 1.41422;
  reach.radius = (hole.radius + hole_rim(hole, rim)) * corner + 1e-4;
  return reach;
}

/// False only when no point of the box low .. low + size lies in the hole: its axis meets neither the box grown by the
/// radius nor the ball around the box grown by it.
bool hole_reaches_box(HoleReach reach, vec3 low_world, float size) {
  const vec3 inverse = 1.0 / (reach.forward + vec3(lessThan(abs(reach.forward), vec3(1e-9))) * 1e-9);
  const vec3 t0 = (low_world - reach.radius - reach.from_world) * inverse;
  const vec3 t1 = (low_world + size + reach.radius - reach.from_world) * inverse;
  const vec3 first = min(t0, t1), last = max(t0, t1);
  if (max(max(first.x, first.y), max(first.z, 0.0)) > min(min(last.x, last.y), min(last.z, reach.length_m))) return false;
  const vec3 apart = low_world + 0.5 * size - reach.from_world;
  const vec3 from_axis = apart - clamp(dot(apart, reach.forward), 0.0, reach.length_m) * reach.forward;
  const float ball = reach.radius + 0.8661 * size;
  return dot(from_axis, from_axis) <= ball * ball;
}

/// Rays around an axis, up to a distance: they begin at most `radius` from its origin and run at most an angle from it.
struct RayCone {
  vec3 origin_world, axis;
  float radius;
  float spread;  // tangent of the angle
  float length_m;
};

/// False only when no ray of the cone meets the hole.
///
/// The ray's distance from the hole's line is at least sqrt(d^2 + (t - t0)^2 sin^2) where the lines of axis and hole are
/// nearest, at t0 and d apart; the cone is spread t wide there. The most that the second can exceed the first
/// by is spread t0 - d sqrt(1 - spread^2 / sin^2).
bool cone_meets_hole(RayCone cone, HoleReach reach) {
  if (!reach.open) return false;
  const float radius = reach.radius + cone.radius;
  const vec3 apart = cone.origin_world - reach.from_world;
  const float b = dot(cone.axis, reach.forward), c = dot(cone.axis, apart), f = dot(reach.forward, apart);
  const float sine2 = max(1.0 - b * b, 0.0), spread2 = cone.spread * cone.spread;
  if (sine2 > 4.0 * spread2 && sine2 > 1e-4) {
    const float t = (b * f - c) / sine2;
    const float d = abs(dot(apart, cross(cone.axis, reach.forward))) * inversesqrt(sine2);
    if (d * sqrt(1.0 - spread2 / sine2) > radius + cone.spread * t + 1e-3) return false;
  }
  // The parts that there are: nearest points of two segments (Ericson 2005, "Real-Time Collision Detection", 5.1.9).
  float s = sine2 > 1e-6 ? clamp((b * f - c) / sine2, 0.0, cone.length_m) : 0.0;
  const float t = clamp(b * s + f, 0.0, reach.length_m);
  s = clamp(b * t - c, 0.0, cone.length_m);
  const vec3 between = apart + s * cone.axis - t * reach.forward;
  const float most = radius + cone.spread * cone.length_m;
  return dot(between, between) <= most * most;
}

#endif
