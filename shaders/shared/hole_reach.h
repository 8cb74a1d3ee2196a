// Conservative bounds of a hole at a time: no point outside loses smoke.
#ifndef BRUME_HOLE_REACH_H
#define BRUME_HOLE_REACH_H
#include "shared/hole.h"
SHARED_BEGIN

/// A capsule around the open part of a hole's axis.
struct HoleReach {
  vec3 from_world;
  float radius;
  vec3 forward;    // unit
  float length_m;  // below 0: the hole is closed
};
SHARED_SIZE(HoleReach, 32);

/// A HoleReach in two rows of 16 bytes.
struct PackedReach {
  vec4 from_radius;
  vec4 forward_length;
};
SHARED_SIZE(PackedReach, 32);

SHARED_FUNCTION PackedReach pack_reach(HoleReach reach) {
  PackedReach packed;
  packed.from_radius = vec4(reach.from_world, reach.radius);
  packed.forward_length = vec4(reach.forward, reach.length_m);
  return packed;
}

SHARED_FUNCTION HoleReach unpack_reach(PackedReach packed) {
  HoleReach reach;
  reach.from_world = vec3(packed.from_radius.x, packed.from_radius.y, packed.from_radius.z);
  reach.radius = packed.from_radius.w;
  reach.forward = vec3(packed.forward_length.x, packed.forward_length.y, packed.forward_length.z);
  reach.length_m = packed.forward_length.w;
  return reach;
}

/// Bounds at a time on the clock of Hole::time_start, with a rim that noise moves by up to `rim` [m].
SHARED_FUNCTION HoleReach hole_reach(Hole hole, float time, float rim) {
  // Open where the front has passed and the hole has not closed: 0 < age - per_metre z < life.
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

/// Shortens the capsule to the part that may meet a box.
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
