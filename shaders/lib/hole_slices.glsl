// Slabs of distance from the eye, in which the holes of a group of pixels are told apart. Needs `frame`.
#ifndef HOLE_SLABS_GLSL
#define HOLE_SLABS_GLSL
#include "shared/frame.h"

/// Equal parts of what lies between the smoke's nearest and farthest point.
struct HoleSlices {
  float begin;      // [m]
  float per_metre;
};

/// Distances from the eye between which there is smoke.
vec2 smoke_reach() {
  const vec3 low = frame.volume.origin_world + frame.volume.bounds_min * frame.volume.voxel_size - frame.camera.eye_world;
  const vec3 high = frame.volume.origin_world + frame.volume.bounds_max * frame.volume.voxel_size - frame.camera.eye_world;
  return vec2(length(max(max(low, -high), vec3(0.0))), length(max(abs(low), abs(high))));
}

HoleSlices hole_slices() {
  const vec2 reach = smoke_reach();
  return HoleSlices(reach.x, float(kHoleSlices) / max(reach.y - reach.x, 1e-3));
}

uint slice_at(HoleSlices slices, float t) { return uint(clamp((t - slices.begin) * slices.per_metre, 0.0, float(kHoleSlices) - 0.5)); }

/// Words of a slice's mask over a list of holes.
uint mask_words(uint count) { return (count + 31u) / 32u; }

#endif
