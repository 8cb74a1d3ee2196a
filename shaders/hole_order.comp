// Puts the entries of every cell in order: equal frames then multiply in the same order, and give equal pictures.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/frame.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(scalar, binding = 1) buffer HoleGrid { uint hole_grid[]; };
layout(scalar, binding = 2) readonly buffer Counters { HoleGridCounters counters; };
layout(push_constant, scalar) uniform Push { HoleGridParams params; };

void main() {
  const uint cells = kHoleCellsPerBlock * min(counters.blocks, params.block_capacity);
  for (uint cell = gl_GlobalInvocationID.x; cell < cells; cell += gl_NumWorkGroups.x * 64u) {
    const uint at = frame.holes.cells_at + 2u * cell;
    const uint first = frame.holes.entries_at + hole_grid[at], count = hole_grid[at + 1u];
    for (uint i = 1u; i < count; ++i) {
      const uint hole = hole_grid[first + i];
      uint to = i;
      for (; to > 0u && hole_grid[first + to - 1u] > hole; --to) hole_grid[first + to] = hole_grid[first + to - 1u];
      hole_grid[first + to] = hole;
    }
  }
}
