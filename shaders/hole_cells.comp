// Enters every pair of a brick and a hole into the cells that the hole reaches: first only counts, then writes. One
// workgroup a pair.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/hole_reach.glsl"
#include "shared/hole_grid.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint kWrite = 0u;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer SlotBricks { ivec3 slot_bricks[]; };
layout(scalar, binding = 2) readonly buffer Holes { Hole holes[]; };
layout(scalar, binding = 3) buffer HoleGrid { uint hole_grid[]; };
layout(scalar, binding = 4) readonly buffer Pairs { uvec2 pairs[]; };
layout(scalar, binding = 5) readonly buffer Counters { HoleGridCounters counters; };
layout(push_constant, scalar) uniform Push { HoleGridParams params; };

const float kCell = 1.0 / float(kHoleCellsPerVoxel);  // [voxels]

void enter(uint block, uint hole, ivec3 cell) {
  const uint number = kHoleCellsPerBlock * block + uint(cell.x + kHoleCellsPerEdge * (cell.y + kHoleCellsPerEdge * cell.z));
  const uint at = frame.holes.cells_at + 2u * number;
  const uint rank = atomicAdd(hole_grid[at + 1u], 1u);
  if (kWrite != 0u) hole_grid[frame.holes.entries_at + hole_grid[at] + rank] = hole;
}

void main() {
  const uint pair_count = min(counters.pairs, params.pair_capacity);
  const int lane = int(gl_LocalInvocationID.x);
  for (uint p = gl_WorkGroupID.x; p < pair_count; p += gl_NumWorkGroups.x) {
    const uint slot = pairs[p].x, hole = pairs[p].y;
    const uint entry = hole_grid[slot];
    if (entry == kHolesEverywhere) continue;
    const HoleReach reach = hole_reach(holes[hole], frame.volume, frame.time, frame.look.hole_rim);
    const vec3 low = vec3(slot_bricks[slot] * kBrickVoxels);

    // Slices of cells across the longest axis of the hole; in each a square around where its axis passes.
    const vec3 a = abs(reach.along_voxel);
    const int major = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    const int u = (major + 1) % 3, v = (major + 2) % 3;
    const float slope_u = reach.along_voxel[u] / reach.along_voxel[major];
    const float slope_v = reach.along_voxel[v] / reach.along_voxel[major];
    const float half_u = reach.radius_voxel + abs(slope_u) * (0.5 * kCell + reach.radius_voxel);
    const float half_v = reach.radius_voxel + abs(slope_v) * (0.5 * kCell + reach.radius_voxel);
    // Four lanes a slice.
    const int slice = lane >> 2;
    const float from_start = low[major] + (float(slice) + 0.5) * kCell - reach.from_voxel[major];
    const float at_u = reach.from_voxel[u] + slope_u * from_start - low[u];
    const float at_v = reach.from_voxel[v] + slope_v * from_start - low[v];
    const int u0 = max(int(floor((at_u - half_u) / kCell)), 0), u1 = min(int(floor((at_u + half_u) / kCell)), kHoleCellsPerEdge - 1);
    const int v0 = max(int(floor((at_v - half_v) / kCell)), 0), v1 = min(int(floor((at_v + half_v) / kCell)), kHoleCellsPerEdge - 1);
    for (int j = v0 + (lane & 3); j <= v1; j += 4) {
      for (int i = u0; i <= u1; ++i) {
        ivec3 cell;
        cell[major] = slice;
        cell[u] = i;
        cell[v] = j;
        if (reaches_box(reach, low + vec3(cell) * kCell, kCell)) enter(entry - 1u, hole, cell);
      }
    }
  }
}
