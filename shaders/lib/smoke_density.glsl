// Density of the smoke at a point: bricks by the texture unit, boundary cells by their planes.
// The includer defines BINDING_PAGES, BINDING_DENSITY, BINDING_CELLS, BINDING_BOUNDARY and BINDING_CORNERS.
#ifndef SMOKE_DENSITY_GLSL
#define SMOKE_DENSITY_GLSL
#include "shared/smoke_volume.h"

layout(scalar, binding = BINDING_PAGES) readonly buffer Pages { uint pages[]; };
layout(binding = BINDING_DENSITY) uniform sampler3D density_atlas;
layout(scalar, binding = BINDING_CELLS) readonly buffer Cells { uint cells[]; };
layout(scalar, binding = BINDING_BOUNDARY) readonly buffer Boundary { BoundaryCell boundary_cells[]; };
layout(scalar, binding = BINDING_CORNERS) readonly buffer Corners { uvec2 corner_sets[]; };

const uint kNoSlot = 0xffffffffu;

/// The slot of a brick, or kNoSlot where there is no smoke.
uint slot_at(SmokeVolumeFrame volume, ivec3 brick) {
  const ivec3 n = (brick >> 3) - volume.window_origin, size = volume.window_size;
  if (any(lessThan(n, ivec3(0))) || any(greaterThanEqual(n, size))) return kNoSlot;
  const uint node = pages[n.x + size.x * (n.y + size.y * n.z)];
  if (node == 0u) return kNoSlot;
  const ivec3 b = brick & (kNodeBricks - 1);
  const uint first = uint(size.x * size.y * size.z) + (node - 1u) * kPageEntries;
  return pages[first + uint(b.x + kNodeBricks * (b.y + kNodeBricks * b.z))] - 1u;
}

/// Where a brick's low corner lies in the atlas, in texels.
vec3 atlas_corner(SmokeVolumeFrame volume, uint slot) {
  const uvec3 bricks = uvec3(volume.atlas_bricks);
  const uvec3 at = uvec3(slot % bricks.x, slot / bricks.x % bricks.y, slot / (bricks.x * bricks.y));
  return vec3(at * uint(kBrickTexels)) + 1.0;
}

/// One over the atlas's size in texels.
vec3 atlas_texel(SmokeVolumeFrame volume) { return 1.0 / vec3(volume.atlas_bricks * kBrickTexels); }

/// Density of a boundary cell's corner set for a point of the brick.
float boundary_density(uint slot, vec3 local_voxel) {
  const vec3 from_centres = local_voxel + 0.5;  // cell 0 of the brick begins half a voxel before it
  const ivec3 cell = clamp(ivec3(from_centres), ivec3(0), ivec3(kBrickCells - 1));
  const uint number = cells[slot * kCellsPerBrick + uint(cell.x + kBrickCells * (cell.y + kBrickCells * cell.z))];
  if (number == 0u) return 0.0;
  const BoundaryCell record = boundary_cells[number - 1u];
  const vec3 f = from_centres - vec3(cell);
  return corner_set_density(corner_sets[record.first_set + boundary_side(record, f - 0.5)], f);
}

/// Density [0, 1] at a point of a brick that has a slot; local_voxel: the point less the brick's low corner, uvw: where
/// it lies in the atlas.
float density_in_brick(uint slot, vec3 local_voxel, vec3 uvw) {
  const vec2 texel = textureLod(density_atlas, uvw, 0.0).rg;
  float density = texel.r;
  if (texel.g < 1.0 - 1.0 / 512.0) { density = boundary_density(slot, local_voxel); }
  return density;
}

/// Density [0, 1] anywhere.
float smoke_density(SmokeVolumeFrame volume, vec3 p_voxel) {
  const ivec3 brick = ivec3(floor(p_voxel / float(kBrickVoxels)));
  const uint slot = slot_at(volume, brick);
  float density = 0.0;
  if (slot != kNoSlot) {
    const vec3 local_voxel = p_voxel - vec3(brick * kBrickVoxels);
    density = density_in_brick(slot, local_voxel, (atlas_corner(volume, slot) + local_voxel) * atlas_texel(volume));
  }
  return density;
}

#endif
