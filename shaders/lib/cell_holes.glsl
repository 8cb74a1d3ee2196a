// Holes along rays to lights: averages over cells of half a voxel (shared/hole_clusters.h).
#ifndef CELL_HOLES_GLSL
#define CELL_HOLES_GLSL
#include "lib/frame.glsl"

layout(scalar, binding = kBindHoleCells) readonly buffer HoleCells { uint hole_cells[]; };

/// Mean fraction of the density that the holes leave around a point of a brick.
float remaining_in_cell(uint slot, vec3 local_voxel) {
  const uint chunk = frame.holes.count > 0u ? hole_cells[slot] : 0u;
  if (chunk == 0u) return 1.0;
  const ivec3 cell = clamp(ivec3(local_voxel * float(kHoleCellsPerVoxel)), ivec3(0), ivec3(kHoleCellsPerEdge - 1));
  const uint index = uint(cell.x + kHoleCellsPerEdge * (cell.y + kHoleCellsPerEdge * cell.z));
  const uint steps = hole_cells[frame.holes.cells_at + kHoleCellsPerChunk * (chunk - 1u) + index];
  return exp2(-float(steps) / kHoleCellStep);
}

#endif
