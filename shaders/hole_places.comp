// Gives every cell the place of its entries, and starts counting anew.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/frame.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(scalar, binding = 1) buffer HoleGrid { uint hole_grid[]; };
layout(scalar, binding = 2) buffer Counters { HoleGridCounters counters; };
layout(push_constant, scalar) uniform Push { HoleGridParams params; };

shared uint group_count;
shared uint group_first;

void main() {
  const uint cells = kHoleCellsPerBlock * min(counters.blocks, params.block_capacity);
  for (uint first = gl_WorkGroupID.x * 64u; first < cells; first += gl_NumWorkGroups.x * 64u) {
    const uint at = frame.holes.cells_at + 2u * (first + gl_LocalInvocationID.x);
    const uint count = hole_grid[at + 1u];
    if (gl_LocalInvocationID.x == 0u) group_count = 0u;
    barrier();
    const uint before = count > 0u ? atomicAdd(group_count, count) : 0u;
    barrier();
    if (gl_LocalInvocationID.x == 0u) group_first = group_count > 0u ? atomicAdd(counters.entries, group_count) : 0u;
    barrier();
    hole_grid[at] = group_first + before;
    hole_grid[at + 1u] = 0u;
    barrier();
  }
}
