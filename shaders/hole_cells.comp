// Subtracts from each cell what a hole removes from it on average. One workgroup per (brick, hole) pair.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "lib/hole_mask.glsl"
#include "lib/hole_reach.glsl"
#include "lib/hole_reaches.glsl"
#include "lib/packed_holes.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindSlotBricks) readonly buffer SlotBricks { PackedIvec3 slot_bricks[]; };
layout(scalar, binding = kBindHoleCells) buffer HoleCells { uint hole_cells[]; };
layout(scalar, binding = kBindHolePairs) readonly buffer Pairs { uvec2 pairs[]; };
layout(scalar, binding = kBindHoleCounters) readonly buffer Counters { HoleCounters counters; };
layout(scalar, push_constant) uniform Push { HoleCellsParams params; };

/// Mean strength of a hole over a cell, from eight points.
float mean_strength(Hole hole, vec3 low_world, float cell) {
  float sum = 0.0;
  for (uint i = 0u; i < 8u; ++i) {
    const vec3 p_world = low_world + cell * (0.25 + 0.5 * vec3(i & 1u, i >> 1u & 1u, i >> 2u));
    sum += hole_strength_masked(hole, p_world, frame.time, 0.0);
  }
  return sum / 8.0;
}

void main() {
  const uint pair_count = min(counters.pairs, params.pair_capacity);
  const int lane = int(gl_LocalInvocationID.x);
  const float cell = frame.smoke.voxel_size / float(kHoleCellsPerVoxel);
  for (uint p = gl_WorkGroupID.x; p < pair_count; p += gl_NumWorkGroups.x) {
    const uint slot = pairs[p].x, chunk = hole_cells[slot];
    if (chunk == 0u) continue;
    const Hole hole = hole_at(pairs[p].y);
    const HoleReach reach = reach_at(pairs[p].y);
    const vec3 low = frame.smoke.origin_world + vec3(unpacked(slot_bricks[slot])) * (cell * float(kHoleCellsPerEdge));

    // Slices of cells across the dominant axis of the hole; in each, a rectangle around the hole's axis.
    const vec3 a = abs(reach.forward);
    const int major = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    const int u = (major + 1) % 3, v = (major + 2) % 3;
    const float slope_u = reach.forward[u] / reach.forward[major], slope_v = reach.forward[v] / reach.forward[major];
    const float half_u = reach.radius + abs(slope_u) * (0.5 * cell + reach.radius);
    const float half_v = reach.radius + abs(slope_v) * (0.5 * cell + reach.radius);
    // Four threads per slice.
    const int slice = lane >> 2;
    const float from_start = low[major] + (float(slice) + 0.5) * cell - reach.from_world[major];
    const float at_u = reach.from_world[u] + slope_u * from_start - low[u];
    const float at_v = reach.from_world[v] + slope_v * from_start - low[v];
    const int u0 = max(int(floor((at_u - half_u) / cell)), 0);
    const int u1 = min(int(floor((at_u + half_u) / cell)), kHoleCellsPerEdge - 1);
    const int v0 = max(int(floor((at_v - half_v) / cell)), 0);
    const int v1 = min(int(floor((at_v + half_v) / cell)), kHoleCellsPerEdge - 1);
    for (int j = v0 + (lane & 3); j <= v1; j += 4) {
      for (int i = u0; i <= u1; ++i) {
        ivec3 at;
        at[major] = slice;
        at[u] = i;
        at[v] = j;
        const vec3 low_world = low + vec3(at) * cell;
        if (!hole_reaches_box(reach, low_world, cell)) continue;
        const float remaining = max(1.0 - mean_strength(hole, low_world, cell), 1.0 / 4096.0);
        const uint index = uint(at.x + kHoleCellsPerEdge * (at.y + kHoleCellsPerEdge * at.z));
        const uint word = frame.holes.cells_at + kHoleCellsPerChunk * (chunk - 1u) + index;
        atomicAdd(hole_cells[word], uint(-log2(remaining) * kHoleCellStep + 0.5));
      }
    }
  }
}
