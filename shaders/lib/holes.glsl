// What holes leave of the smoke at a point. The includer defines BINDING_HOLES, BINDING_HOLE_GRID and BINDING_HOLE_MASKS,
// and has `frame`.
#ifndef HOLES_GLSL
#define HOLES_GLSL
#include "shared/frame.h"
#include "shared/hole.h"

layout(scalar, binding = BINDING_HOLES) readonly buffer Holes { Hole holes[]; };
layout(scalar, binding = BINDING_HOLE_GRID) readonly buffer HoleGrid { uint hole_grid[]; };
layout(binding = BINDING_HOLE_MASKS) uniform sampler2D hole_masks;
#include "lib/hole_mask.glsl"

/// What left_by_holes wants to know of a brick.
uint holes_in_slot(uint slot) { return frame.holes.hole_count > frame.holes.wide_count ? hole_grid[slot] : 0u; }

bool any_holes(uint in_slot) { return in_slot != 0u || frame.holes.wide_count > 0u; }

/// Share of the density that the holes leave at a point of a brick; rim_noise_metres as hole_strength takes it.
float left_by_holes(uint in_slot, vec3 local_voxel, vec3 p_world, float rim_noise_metres) {
  // The holes that every sample asks, then those of the cell.
  uint first = 0u, count = 0u;
  bool everywhere = in_slot == kHolesEverywhere;
  if (in_slot != 0u && !everywhere) {
    const ivec3 cell = clamp(ivec3(local_voxel * float(kHoleCellsPerVoxel)), ivec3(0), ivec3(kHoleCellsPerEdge - 1));
    const uint number = kHoleCellsPerBlock * (in_slot - 1u) + uint(cell.x + kHoleCellsPerEdge * (cell.y + kHoleCellsPerEdge * cell.z));
    const uint at = frame.holes.cells_at + 2u * number;
    first = frame.holes.entries_at + hole_grid[at];
    count = hole_grid[at + 1u];
  }
  const uint direct = everywhere ? frame.holes.hole_count : frame.holes.wide_count;
  float left = 1.0;
  for (uint i = 0u; i < direct + count && left > 0.0; ++i) {
    const uint hole = i < direct ? i : hole_grid[first + i - direct];
    left *= 1.0 - hole_strength_masked(holes[hole], p_world, frame.time, rim_noise_metres);
  }
  return left;
}

#endif
