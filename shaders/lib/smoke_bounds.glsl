// Rays against the bounds of the smoke.
#ifndef SMOKE_BOUNDS_GLSL
#define SMOKE_BOUNDS_GLSL
#include "shared/smoke_volume.h"

/// The part of a ray inside the volume's bounds, from 0 to t_end: x >= y where there is none.
vec2 clip_to_bounds(VolumeLayout volume, vec3 origin_world, vec3 direction, float t_end) {
  const vec3 inverse = 1.0 / (direction + vec3(equal(direction, vec3(0.0))) * 1e-9);
  const vec3 low = volume.origin_world + volume.bounds_min * volume.voxel_size - origin_world;
  const vec3 high = volume.origin_world + volume.bounds_max * volume.voxel_size - origin_world;
  const vec3 near = min(low * inverse, high * inverse), far = max(low * inverse, high * inverse);
  return vec2(max(max(near.x, near.y), max(near.z, 0.0)), min(min(far.x, far.y), min(far.z, t_end)));
}

#endif
