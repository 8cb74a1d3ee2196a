// Where bricks are, and what boundary cells hold.
// The includer defines BINDING_PAGES, BINDING_CELLS, BINDING_BOUNDARY and BINDING_CORNERS.
#ifndef SMOKE_BRICKS_GLSL
#define SMOKE_BRICKS_GLSL
#include "shared/smoke_volume.h"

layout(scalar, binding = BINDING_PAGES) readonly buffer Pages { uint pages[]; };
layout(scalar, binding = BINDING_CELLS) readonly buffer Cells { uint cells[]; };
layout(scalar, binding = BINDING_BOUNDARY) readonly buffer Boundary { BoundaryCell boundary_cells[]; };
layout(scalar, binding = BINDING_CORNERS) readonly buffer Corners { uvec2 corner_sets[]; };

const uint kNoSlot = 0xffffffffu;

/// The slot of a brick, or kNoSlot where there is no smoke; then `empty_edge` is the edge [voxels] of the aligned cube
/// around the brick that has none.
uint slot_at(VolumeLayout volume, ivec3 brick, out int empty_edge) {
  empty_edge = kBrickVoxels * kNodeBricks;
  const ivec3 n = (brick >> 3) - volume.window_origin, size = volume.window_size;
  if (any(lessThan(n, ivec3(0))) || any(greaterThanEqual(n, size))) return kNoSlot;
  const uint node = pages[n.x + size.x * (n.y + size.y * n.z)];
  if (node == 0u) return kNoSlot;
  empty_edge = kBrickVoxels;
  const ivec3 b = brick & (kNodeBricks - 1);
  const uint first = uint(size.x * size.y * size.z) + (node - 1u) * kPageEntries;
  return pages[first + uint(b.x + kNodeBricks * (b.y + kNodeBricks * b.z))] - 1u;
}

/// Where a brick's low corner lies in the atlas, in texels.
vec3 atlas_corner(VolumeLayout volume, uint slot) {
  const uvec3 bricks = uvec3(volume.atlas_bricks);
  const uvec3 at = uvec3(slot % bricks.x, slot / bricks.x % bricks.y, slot / (bricks.x * bricks.y));
  return vec3(at * uint(kBrickTexels)) + 1.0;
}

/// One over the atlas's size in texels.
vec3 atlas_texel(VolumeLayout volume) { return 1.0 / vec3(volume.atlas_bricks * kBrickTexels); }

/// What a point of a brick holds.
struct SmokeSample {
  float density;      // [0, 1]
  vec3 light_offset;  // where light is looked up, less the point [voxels]: off the walls, so that none comes through
};

/// On which side of a plane a point lies, as a bit; `offset` grows by the way to one voxel off the plane, where no
/// texel beyond it has weight any more.
uint plane_side(uint plane, vec3 p_from_centre, inout vec3 offset) {
  const vec3 normal = plane_normal(plane);
  const float apart = dot(normal, p_from_centre) - plane_offset(plane);
  const bool there = plane != 0u;
  offset += there ? normal * ((apart > 0.0 ? 1.0 : -1.0) * max(1.0 - abs(apart), 0.0)) : vec3(0.0);
  return there && apart > 0.0 ? 1u : 0u;
}

/// A boundary cell's corner set for a point of the brick.
SmokeSample boundary_sample(uint slot, vec3 local_voxel) {
  const vec3 from_centres = local_voxel + 0.5;  // cell 0 of the brick begins half a voxel before it
  const ivec3 cell = clamp(ivec3(from_centres), ivec3(0), ivec3(kBrickCells - 1));
  const uint number = cells[slot * kCellsPerBrick + uint(cell.x + kBrickCells * (cell.y + kBrickCells * cell.z))];
  if (number == 0u) return SmokeSample(0.0, vec3(0.0));
  const BoundaryCell record = boundary_cells[number - 1u];
  const vec3 f = from_centres - vec3(cell);
  vec3 offset = vec3(0.0);
  uint side = plane_side(record.plane0, f - 0.5, offset);
  side |= plane_side(record.plane1, f - 0.5, offset) << 1u;
  side |= plane_side(record.plane2, f - 0.5, offset) << 2u;
  // The brick has one texel around it.
  const vec3 at = clamp(local_voxel + offset, vec3(-0.5), vec3(float(kBrickVoxels) + 0.5));
  return SmokeSample(corner_set_density(corner_sets[record.first_set + side], f), at - local_voxel);
}

#endif
