// How far a hole reaches at a time: never less than where it takes anything away from smoke.
#ifndef BRUME_HOLE_REACH_H
#define BRUME_HOLE_REACH_H
#include "shared/hole.h"
SHARED_BEGIN

/// The open part of a hole's axis, and how far from it the hole reaches.
struct HoleReach {
  vec3 from_world;
  float radius;
  vec3 forward;    // unit
  float length_m;  // below 0: the hole takes nothing away anywhere
};
SHARED_SIZE(HoleReach, 32);

/// At a time on the hole's clock, with a rim that noise moves by up to `rim` [m].
SHARED_FUNCTION HoleReach hole_reach(Hole hole, float time, float rim) {
  // Open where the front has been and the hole is not closed again: 0 < age - per_metre z < life.
  float age = time - hole.time_start;
  float per_metre = hole.time_to_reach_far / max(hole.distance_to_far, 1e-6f);
  float life = max(hole.time_to_expand, 1e-6f) + hole.time_to_stay_open + max(hole.time_to_fade, 1e-6f);
  float slack = 1e-4f;  // [s], for rounding
  float near = 0.0f;
  float far = hole.distance_to_far;
  if (per_metre > 1e-9f) {
    near = max(near, (age - life - slack) / per_metre);
    far = min(far, (age + slack) / per_metre);
  }
  bool open = age > 0.0f && near < far && (per_metre > 1e-9f || age < life + slack);
  float corner = hole.shape == kHoleCylinder ? 1.0f : 1.41422f;
  HoleReach reach;
  reach.from_world = hole.origin_world + near * hole.forward;
  reach.radius = (hole.radius + hole_rim(hole, rim)) * corner + 1e-4f;
  reach.forward = hole.forward;
  reach.length_m = open ? far - near : -1.0f;
  return reach;
}

/// The part of it whose points within its radius may lie in a box.
SHARED_FUNCTION HoleReach hole_reach_within(HoleReach reach, vec3 low_world, vec3 high_world) {
  vec3 from = reach.from_world;
  vec3 along = reach.forward;
  vec3 low = low_world - vec3(reach.radius) - from;
  vec3 high = high_world + vec3(reach.radius) - from;
  float near = 0.0f;
  float far = reach.length_m;
  for (int axis = 0; axis < 3; ++axis) {
    float slope = abs(along[axis]) > 1e-6f ? along[axis] : 1e-6f;
    near = max(near, min(low[axis] / slope, high[axis] / slope) - 1e-3f);
    far = min(far, max(low[axis] / slope, high[axis] / slope) + 1e-3f);
  }
  reach.from_world = from + near * along;
  reach.length_m = far - near;
  return reach;
}

SHARED_END
#endif
