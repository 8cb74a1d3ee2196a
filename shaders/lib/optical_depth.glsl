// How much smoke stands between two points. Needs `frame`, `filtered_density_atlas` and the bindings of
// lib/smoke_bricks.glsl and lib/cell_holes.glsl.
#ifndef OPTICAL_DEPTH_GLSL
#define OPTICAL_DEPTH_GLSL
#include "lib/cell_holes.glsl"
#include "lib/smoke_bricks.glsl"

/// A point of the smoke as light sees it, for those who ask one at a time: with what the noise leaves in the mean of a
/// texel, since light is as coarse as those.
struct MeanSmoke {
  float density;  // [0, 1]
  vec3 local_voxel;
  int empty_edge;  // without a slot: of the aligned cube around the point that has no smoke [voxels]
  uint slot;       // kNoSlot: no smoke anywhere near
};

MeanSmoke mean_smoke_at(vec3 p_voxel) {
  const vec3 brick = floor(p_voxel / float(kBrickVoxels));
  MeanSmoke smoke;
  smoke.density = 0.0;
  smoke.local_voxel = p_voxel - brick * float(kBrickVoxels);
  smoke.slot = slot_at(frame.volume, ivec3(brick), smoke.empty_edge);
  if (smoke.slot != kNoSlot) {
    const vec3 uvw = (atlas_corner(frame.volume, smoke.slot) + smoke.local_voxel) * atlas_texel(frame.volume);
    const vec2 left = textureLod(filtered_density_atlas, uvw, 0.0).rg;
    smoke.density = left.r;
    if (left.r < 0.0) smoke.density = boundary_sample(smoke.slot, smoke.local_voxel).density * left.g;
  }
  return smoke;
}

/// The same with what holes leave of it.
MeanSmoke seen_smoke_at(vec3 p_voxel) {
  MeanSmoke smoke = mean_smoke_at(p_voxel);
  if (smoke.density > 0.0) smoke.density *= remaining_in_cell(smoke.slot, smoke.local_voxel);
  return smoke;
}

/// Where a ray from a point leaves the cube of an edge that is aligned to it [voxels].
float leaves_cube(vec3 p_voxel, vec3 inverse, float edge) {
  const vec3 low = floor(p_voxel / edge) * edge;
  const vec3 way = (mix(low, low + edge, greaterThan(inverse, vec3(0.0))) - p_voxel) * inverse;
  return min(way.x, min(way.y, way.z));
}

/// Optical depth from a point along a unit direction, at most `distance_m` metres. Steps grow with the distance, as what is
/// near decides most, and fill the way to its end or to that of the box around what may dim it: a voxel each in the mean up
/// to 24 / coarse voxels, then ever longer.
float optical_depth(vec3 p_voxel, vec3 direction, float distance_m, float coarse) {
  const VolumeLayout volume = frame.volume;
  const vec3 inverse = 1.0 / (direction + vec3(equal(direction, vec3(0.0))) * 1e-6);
  const vec3 t0 = (frame.caster_bounds_min - p_voxel) * inverse, t1 = (frame.caster_bounds_max - p_voxel) * inverse;
  const vec3 near = min(t0, t1), far = max(t0, t1);
  const float begin = max(max(near.x, near.y), max(near.z, 0.0));
  const float reach = min(min(far.x, far.y), min(far.z, distance_m / volume.voxel_size)) - begin;
  if (reach <= 0.0) return 0.0;
  const float per_voxel = volume.voxel_size * frame.look.extinction;
  const float steps = min(ceil(reach), ceil(max(24.0, sqrt(144.0 + 48.0 * reach) - 12.0) / coarse));
  float depth = 0.0;
  for (float i = 0.0; i < steps && depth * per_voxel <= 12.0; ++i) {
    const float before = reach * (i / steps) * (0.5 + 0.5 * i / steps);
    const float after = reach * ((i + 1.0) / steps) * (0.5 + 0.5 * (i + 1.0) / steps), middle = begin + 0.5 * (before + after);
    const vec3 p = p_voxel + direction * middle;
    const MeanSmoke smoke = seen_smoke_at(p);
    depth += smoke.density * (after - before);
    if (smoke.slot == kNoSlot) {
      // On to the step in which the ray leaves where nothing is, or a little before.
      const float leaves = middle + leaves_cube(p, inverse, float(smoke.empty_edge)) - 0.01 - begin;
      i = max(i, floor(steps * (sqrt(0.25 + 2.0 * leaves / reach) - 0.5)) - 1.0);
    }
  }
  return depth * per_voxel;
}

#endif
