// Cells of the smoke that a surface runs through: density by the sides of its planes.
#ifndef BOUNDARY_CELLS_GLSL
#define BOUNDARY_CELLS_GLSL
#include "shared/smoke_volume.h"

layout(scalar, binding = kBindCells) readonly buffer Cells { uint cells[]; };
layout(scalar, binding = kBindBoundary) readonly buffer Boundary { BoundaryCell boundary_cells[]; };
layout(scalar, binding = kBindCorners) readonly buffer Corners { uvec2 corner_sets[]; };

/// Smoke at a point of a brick.
struct BrickSample {
  float density;      // [0, 1]
  vec3 light_offset;  // from the point to its light lookup [voxels]: off the walls, so that no light leaks through
};

/// Side of a plane that a point lies on, as a bit. Moves `offset` to one voxel off the plane, where texels beyond it
/// have no weight.
uint plane_side(uint plane, vec3 p_from_centre, inout vec3 offset) {
  const vec3 normal = plane_normal(plane);
  const float height = dot(normal, p_from_centre) - plane_offset(plane);
  const bool exists = plane != 0u;
  offset += exists ? normal * ((height > 0.0 ? 1.0 : -1.0) * max(1.0 - abs(height), 0.0)) : vec3(0.0);
  return exists && height > 0.0 ? 1u : 0u;
}

/// What boundary_sample returns where no surface runs through the cell: on its faces, rounding finds another cell than
/// the texture unit, which met a texel in the wall. The plain texels a bit off the faces are right there.
const float kNoBoundary = -1.0;

/// From a point of a brick towards the middle of its cell, by more than the resolution of the texture unit [voxels].
vec3 off_faces(vec3 local_voxel) { return (0.5 - fract(local_voxel + 0.5)) / 64.0; }

/// The record of the cell that a point of the brick is in, and the point in the cell, [0, 1]; false outside of boundary
/// cells.
bool boundary_cell_at(uint slot, vec3 local_voxel, out BoundaryCell record, out vec3 f) {
  const vec3 from_centres = local_voxel + 0.5;  // cell 0 of the brick begins half a voxel before it
  const ivec3 cell = clamp(ivec3(from_centres), ivec3(0), ivec3(kBrickCells - 1));
  const uint number = cells[slot * kCellsPerBrick + uint(cell.x + kBrickCells * (cell.y + kBrickCells * cell.z))];
  if (number == 0u) return false;
  record = boundary_cells[number - 1u];
  f = from_centres - vec3(cell);
  return true;
}

/// Sides of the planes of a cell that a point lies on, one bit each. Moves `offset` off the planes.
uint plane_sides(BoundaryCell record, vec3 f, inout vec3 offset) {
  uint sides = plane_side(record.plane0, f - 0.5, offset);
  // Most cells have one plane.
  if (record.plane1 != 0u) {
    sides |= plane_side(record.plane1, f - 0.5, offset) << 1u;
    if (record.plane2 != 0u) sides |= plane_side(record.plane2, f - 0.5, offset) << 2u;
  }
  return sides;
}

/// Smoke of a boundary cell at a point of the brick; of density kNoBoundary outside of such cells.
BrickSample boundary_sample(uint slot, vec3 local_voxel) {
  BoundaryCell record;
  vec3 f, offset = vec3(0.0);
  if (!boundary_cell_at(slot, local_voxel, record, f)) return BrickSample(kNoBoundary, vec3(0.0));
  const uint sides = plane_sides(record, f, offset);
  // The apron of the brick is one texel wide.
  const vec3 light_at = clamp(local_voxel + offset, vec3(-0.5), vec3(float(kBrickVoxels) + 0.5));
  return BrickSample(corner_set_density(corner_sets[record.first_set + sides], f), light_at - local_voxel);
}

/// Whether a surface runs between a point of the brick and the centre of a voxel around it.
bool is_behind_surface(uint slot, vec3 local_voxel, vec3 to_centre_voxel) {
  BoundaryCell record;
  vec3 f, offset = vec3(0.0);
  if (!boundary_cell_at(slot, local_voxel, record, f)) return false;
  return plane_sides(record, f, offset) != plane_sides(record, f + to_centre_voxel, offset);
}

#endif
