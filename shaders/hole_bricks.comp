// Which holes reach which bricks: a list of pairs, and a block of empty cells for each brick that a hole reaches.
// One workgroup a brick.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/hole_reach.glsl"
#include "shared/hole_grid.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer SlotBricks { ivec3 slot_bricks[]; };
layout(scalar, binding = 2) readonly buffer Holes { Hole holes[]; };
layout(scalar, binding = 3) writeonly buffer HoleGrid { uint hole_grid[]; };
layout(scalar, binding = 4) writeonly buffer Pairs { uvec2 pairs[]; };
layout(scalar, binding = 5) buffer Counters { HoleGridCounters counters; };
layout(push_constant, scalar) uniform Push { HoleGridParams params; };

shared uint reached;
shared bool complete;
shared uint block;

void main() {
  const uint slot = gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
  if (slot >= params.slot_count) return;
  const uint lane = gl_LocalInvocationID.x;
  if (lane == 0u) {
    reached = 0u;
    complete = true;
  }
  barrier();
  const vec3 low = vec3(slot_bricks[slot] * kBrickVoxels);
  for (uint i = frame.holes.wide_count + lane; i < frame.holes.hole_count; i += 64u) {
    const HoleReach reach = hole_reach(holes[i], frame.volume, frame.time, frame.look.hole_rim);
    if (!reach.open || !reaches_box(reach, low, float(kBrickVoxels))) continue;
    const uint at = atomicAdd(counters.pairs, 1u);
    if (at < params.pair_capacity) {
      pairs[at] = uvec2(slot, i);
    } else {
      complete = false;
    }
    reached = 1u;
  }
  barrier();
  if (reached == 0u) {
    if (lane == 0u) hole_grid[slot] = 0u;
    return;
  }
  if (lane == 0u) block = atomicAdd(counters.blocks, 1u);
  barrier();
  const bool fits = complete && block < params.block_capacity;
  if (lane == 0u) hole_grid[slot] = fits ? block + 1u : kHolesEverywhere;
  if (!fits) return;
  const uint first = frame.holes.cells_at + 2u * kHoleCellsPerBlock * block;
  for (uint i = lane; i < 2u * kHoleCellsPerBlock; i += 64u) hole_grid[first + i] = 0u;
}
