// How much smoke stands between two points. Needs `frame`, `share_atlas` and the bindings of
// lib/smoke_density.glsl and lib/cell_holes.glsl.
#ifndef OPTICAL_DEPTH_GLSL
#define OPTICAL_DEPTH_GLSL
#include "lib/cell_holes.glsl"
#include "lib/smoke_density.glsl"

/// The smoke at a point with what the noise leaves of it in the mean of a texel: light is as coarse as those.
SmokePoint mean_smoke_at(vec3 p_voxel) {
  SmokePoint point = smoke_at(frame.volume, p_voxel);
  if (point.density > 0.0) {
    const vec3 uvw = (atlas_corner(frame.volume, point.slot) + point.local_voxel) * atlas_texel(frame.volume);
    point.density *= textureLod(share_atlas, uvw, 0.0).r;
  }
  return point;
}

/// Density as light sees it.
float seen_density(vec3 p_voxel) {
  const SmokePoint point = mean_smoke_at(p_voxel);
  return point.density > 0.0 ? point.density * left_in_cell(point.slot, point.local_voxel) : 0.0;
}

/// Optical depth from a point along a unit direction, at most `distance_m` metres, in at most `max_steps` steps. They
/// grow with the distance: what is near decides most.
float optical_depth(vec3 p_voxel, vec3 direction, float distance_m, float max_steps) {
  const SmokeVolumeFrame volume = frame.volume;
  // The part inside the smoke's bounds.
  const vec3 inverse = 1.0 / (direction + vec3(equal(direction, vec3(0.0))) * 1e-6);
  const vec3 t0 = (frame.shading_min - p_voxel) * inverse, t1 = (frame.shading_max - p_voxel) * inverse;
  const vec3 near = min(t0, t1), far = max(t0, t1);
  const float begin = max(max(near.x, near.y), max(near.z, 0.0));
  const float reach = min(min(far.x, far.y), min(far.z, distance_m / volume.voxel_size)) - begin;
  if (reach <= 0.0) return 0.0;
  const float per_voxel = volume.voxel_size * frame.look.extinction;
  const float steps = clamp(ceil(reach), 1.0, max_steps);
  float depth = 0.0, before = 0.0;
  for (float i = 1.0; i <= steps; ++i) {
    const float after = reach * (i / steps) * (0.5 + 0.5 * i / steps);
    depth += seen_density(p_voxel + direction * (begin + 0.5 * (before + after))) * (after - before);
    if (depth * per_voxel > 12.0) break;
    before = after;
  }
  return depth * per_voxel;
}

#endif
