// The smoke as light meets it: optical depth along rays, extinction at points (lib/media_light.glsl).
#ifndef OPTICAL_DEPTH_GLSL
#define OPTICAL_DEPTH_GLSL
#include "lib/boundary_cells.glsl"
#include "lib/bricks.glsl"
#include "lib/cell_holes.glsl"

layout(binding = kBindFilteredDensity) uniform sampler3D filtered_density_atlas;

/// Smoke at a point with the mean erosion of its texel: light is as coarse as the texels.
struct MeanSmoke {
  float density;  // [0, 1]
  vec3 local_voxel;
  int empty_edge;  // without a slot: edge of the aligned empty cube around the point [voxels]
  uint slot;       // kNoSlot: no smoke in the brick
};

MeanSmoke mean_smoke_at(vec3 p_voxel) {
  const vec3 brick = floor(p_voxel / float(kBrickVoxels));
  MeanSmoke smoke;
  smoke.density = 0.0;
  smoke.local_voxel = p_voxel - brick * float(kBrickVoxels);
  smoke.slot = slot_at(frame.smoke.bricks, ivec3(brick), smoke.empty_edge);
  if (smoke.slot != kNoSlot) {
    const vec3 corner = atlas_corner(frame.smoke.bricks, smoke.slot);
    const vec3 uvw = (corner + smoke.local_voxel) * frame.smoke.bricks.atlas_texel;
    const vec2 filtered = textureLod(filtered_density_atlas, uvw, 0.0).rg;
    smoke.density = filtered.r;
    // On the face of a cell: nothing, which only one sample in thousands of a ray for light meets.
    if (filtered.r < 0.0)
      smoke.density = max(boundary_sample(smoke.slot, smoke.local_voxel).density, 0.0) * filtered.g;
  }
  return smoke;
}

/// The same after holes.
MeanSmoke cut_smoke_at(vec3 p_voxel) {
  MeanSmoke smoke = mean_smoke_at(p_voxel);
  if (smoke.density > 0.0) smoke.density *= remaining_in_cell(smoke.slot, smoke.local_voxel);
  return smoke;
}

vec3 smoke_from_world(vec3 p_world) { return (p_world - frame.smoke.origin_world) / frame.smoke.voxel_size; }

/// Extinction at a point of the caster bounds [1/m]; 0 outside of them.
float smoke_extinction(vec3 p_voxel) {
  const bool inside =
      all(greaterThan(p_voxel, frame.caster_bounds_min)) && all(lessThan(p_voxel, frame.caster_bounds_max));
  return inside ? frame.look.extinction * cut_smoke_at(p_voxel).density : 0.0;
}

/// Distance along a ray from a point to where it leaves the aligned cube of this edge [voxels].
float distance_out_of_cube(vec3 p_voxel, vec3 inverse, float edge) {
  const vec3 low = floor(p_voxel / edge) * edge;
  const vec3 exits = (mix(low, low + edge, greaterThan(inverse, vec3(0.0))) - p_voxel) * inverse;
  return min(exits.x, min(exits.y, exits.z));
}

/// Optical depth from a point along a unit direction, up to `distance_m` metres. Steps grow with the distance, because
/// near smoke matters most, and end at the distance or at the caster bounds: one voxel each on average up to
/// 24 / coarse voxels, longer beyond.
float smoke_depth(vec3 p_voxel, vec3 direction, float distance_m, float coarse) {
  const VolumeLayout volume = frame.smoke;
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
    const float after = reach * ((i + 1.0) / steps) * (0.5 + 0.5 * (i + 1.0) / steps);
    const float middle = begin + 0.5 * (before + after);
    const vec3 p = p_voxel + direction * middle;
    const MeanSmoke smoke = cut_smoke_at(p);
    depth += smoke.density * (after - before);
    if (smoke.slot == kNoSlot) {
      // Skip to the step in which the ray leaves the empty cube, or slightly before.
      const float leaves = middle + distance_out_of_cube(p, inverse, float(smoke.empty_edge)) - 0.01 - begin;
      i = max(i, floor(steps * (sqrt(0.25 + 2.0 * leaves / reach) - 0.5)) - 1.0);
    }
  }
  return depth * per_voxel;
}

#endif
