// What holes leave of the smoke on its way to light: averages over cells of half a voxel (shared/hole_clusters.h).
// The includer has `frame` and defines BINDING_HOLE_CELLS.
#ifndef CELL_HOLES_GLSL
#define CELL_HOLES_GLSL
#include "shared/frame.h"

layout(scalar, binding = BINDING_HOLE_CELLS) readonly buffer HoleCells { uint hole_cells[]; };

/// Share of the density that the holes leave around a point of a brick.
float remaining_in_cell(uint slot, vec3 local_voxel) {
  const uint block = frame.holes.count > 0u ? hole_cells[slot] : 0u;
  if (block == 0u) return 1.0;
  const ivec3 cell = clamp(ivec3(local_voxel * float(kHoleCellsPerVoxel)), ivec3(0), ivec3(kHoleCellsPerEdge - 1));
  const uint number = kHoleCellsPerChunk * (block - 1u) + uint(cell.x + kHoleCellsPerEdge * (cell.y + kHoleCellsPerEdge * cell.z));
  return exp2(-float(hole_cells[frame.holes.cells_at + number]) / kHoleCellStep);
}

#endif
