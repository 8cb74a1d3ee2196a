// How far a hole reaches at a time: never less than where it takes anything away.
#ifndef HOLE_REACH_GLSL
#define HOLE_REACH_GLSL
#include "shared/frame.h"
#include "shared/hole.h"

/// The open part of a hole's axis, and how far from it the hole reaches.
struct HoleReach {
  vec3 from_voxel;
  vec3 along_voxel;  // from one end of the open part to the other
  float radius_voxel;
  bool open;
};

HoleReach hole_reach(Hole hole, SmokeVolumeFrame volume, float time, float rim) {
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
  reach.from_voxel = (hole.origin_world + near * hole.forward - volume.origin_world) / volume.voxel_size;
  reach.along_voxel = hole.forward * ((far - near) / volume.voxel_size);
  const float corner = hole.shape == kHoleCylinder ? 1.0 : 1.41422;
  reach.radius_voxel = max(hole.radius + rim, 0.0) * corner / volume.voxel_size + 1e-3;
  return reach;
}

/// False only when no point of the box low .. low + size lies in the hole: its axis meets neither the box grown by the
/// radius nor the ball around the box grown by it.
bool reaches_box(HoleReach reach, vec3 low, float size) {
  const vec3 inverse = 1.0 / (reach.along_voxel + vec3(lessThan(abs(reach.along_voxel), vec3(1e-9))) * 1e-9);
  const vec3 t0 = (low - reach.radius_voxel - reach.from_voxel) * inverse;
  const vec3 t1 = (low + size + reach.radius_voxel - reach.from_voxel) * inverse;
  const vec3 first = min(t0, t1), last = max(t0, t1);
  if (max(max(first.x, first.y), max(first.z, 0.0)) > min(min(last.x, last.y), min(last.z, 1.0))) return false;
  const vec3 apart = low + 0.5 * size - reach.from_voxel;
  const float t = clamp(dot(apart, reach.along_voxel) / max(dot(reach.along_voxel, reach.along_voxel), 1e-12), 0.0, 1.0);
  const float ball = reach.radius_voxel + 0.8661 * size;
  const vec3 from_axis = apart - t * reach.along_voxel;
  return dot(from_axis, from_axis) <= ball * ball;
}

#endif
