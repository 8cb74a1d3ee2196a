// Which holes reach which bricks: a list of pairs, and a block of cells, all full, for each brick that a hole reaches.
// One workgroup a brick.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/hole_reach.glsl"
#include "shared/frame.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer SlotBricks { ivec3 slot_bricks[]; };
layout(binding = 2) readonly buffer Holes { vec4 hole_rows[]; };
layout(scalar, binding = 3) buffer HoleCells { uint hole_cells[]; };
layout(scalar, binding = 4) writeonly buffer Pairs { uvec2 pairs[]; };
layout(scalar, binding = 5) buffer Counters { HoleCounters counters; };
layout(push_constant, scalar) uniform Impulse { HoleCellsParams params; };
#include "lib/hole_rows.glsl"

shared bool reached;
shared uint block;

void main() {
  const uint slot = gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
  if (slot >= params.slot_count) return;
  const uint lane = gl_LocalInvocationID.x;
  if (lane == 0u) reached = false;
  barrier();
  const float edge = float(kBrickVoxels) * frame.volume.voxel_size;
  const vec3 low = frame.volume.origin_world + vec3(slot_bricks[slot]) * edge;
  for (uint i = lane; i < frame.holes.count; i += 64u) {
    const HoleReach reach = reach_from_rows(i);
    if (!hole_reaches_box(reach, low, edge)) continue;
    const uint at = atomicAdd(counters.pairs, 1u);
    if (at < params.pair_capacity) pairs[at] = uvec2(slot, i);
    reached = true;
  }
  barrier();
  if (lane == 0u) {
    block = reached ? atomicAdd(counters.blocks, 1u) : params.block_capacity;
    hole_cells[slot] = block < params.block_capacity ? block + 1u : 0u;
  }
  barrier();
  if (block >= params.block_capacity) return;
  const uint first = frame.holes.cells_at + kHoleCellsPerChunk * block;
  for (uint i = lane; i < kHoleCellsPerChunk; i += 64u) hole_cells[first + i] = 0u;
}
