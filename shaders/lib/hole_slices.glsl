// Slices of distance from the eye that divide the holes of a tile of pixels into clusters.
#ifndef HOLE_SLICES_GLSL
#define HOLE_SLICES_GLSL
#include "lib/frame.glsl"

/// kHoleSlices equal parts between the nearest and the farthest point of the smoke.
struct HoleSlices {
  float begin;      // [m]
  float per_metre;
};

/// Distances along rays to the nearest and the farthest point of the smoke's bounds.
vec2 smoke_reach() {
  const VolumeLayout volume = frame.smoke;
  if (frame.camera.parallel != 0.0) {
    const vec3 middle = volume.origin_world + 0.5 * (volume.bounds_min + volume.bounds_max) * volume.voxel_size;
    const vec3 half_size = 0.5 * (volume.bounds_max - volume.bounds_min) * volume.voxel_size;
    const float along = dot(middle - frame.camera.eye_world, frame.camera.forward);
    const float reach = dot(half_size, abs(frame.camera.forward));
    return max(vec2(along - reach, along + reach), vec2(0.0));
  }
  const vec3 low = volume.origin_world + volume.bounds_min * volume.voxel_size - frame.camera.eye_world;
  const vec3 high = volume.origin_world + volume.bounds_max * volume.voxel_size - frame.camera.eye_world;
  return vec2(length(max(max(low, -high), vec3(0.0))), length(max(abs(low), abs(high))));
}

HoleSlices hole_slices() {
  const vec2 reach = smoke_reach();
  return HoleSlices(reach.x, float(kHoleSlices) / max(reach.y - reach.x, 1e-3));
}

uint slice_at(HoleSlices slices, float t) {
  return uint(clamp((t - slices.begin) * slices.per_metre, 0.0, float(kHoleSlices) - 0.5));
}

/// Words of a mask over a list of holes.
uint mask_words(uint count) { return (count + 31u) / 32u; }

#endif
