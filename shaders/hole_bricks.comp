// Finds the bricks that holes reach: a list of (brick, hole) pairs, and a chunk of full cells for each brick that any
// hole reaches. One workgroup per brick.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "lib/hole_reach.glsl"
#include "lib/hole_reaches.glsl"

layout(local_size_x = 64) in;
layout(scalar, binding = kBindSlotBricks) readonly buffer SlotBricks { PackedIvec3 slot_bricks[]; };
layout(scalar, binding = kBindHoleCells) buffer HoleCells { uint hole_cells[]; };
layout(scalar, binding = kBindHolePairs) writeonly buffer Pairs { uvec2 pairs[]; };
layout(scalar, binding = kBindHoleCounters) buffer Counters { HoleCounters counters; };
layout(scalar, push_constant) uniform Push { HoleCellsParams params; };

shared bool reached;
shared uint chunk;

void main() {
  const uint slot = gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
  if (slot >= params.slot_count) return;
  const uint lane = gl_LocalInvocationID.x;
  if (lane == 0u) reached = false;
  barrier();
  const float edge = float(kBrickVoxels) * frame.smoke.voxel_size;
  const vec3 low = frame.smoke.origin_world + vec3(unpacked(slot_bricks[slot])) * edge;
  for (uint i = lane; i < frame.holes.count; i += 64u) {
    const HoleReach reach = reach_at(i);
    if (!hole_reaches_box(reach, low, edge)) continue;
    const uint at = atomicAdd(counters.pairs, 1u);
    if (at < params.pair_capacity) pairs[at] = uvec2(slot, i);
    reached = true;
  }
  barrier();
  if (lane == 0u) {
    chunk = reached ? atomicAdd(counters.blocks, 1u) : params.block_capacity;
    hole_cells[slot] = chunk < params.block_capacity ? chunk + 1u : 0u;
  }
  barrier();
  if (chunk >= params.block_capacity) return;
  const uint first = frame.holes.cells_at + kHoleCellsPerChunk * chunk;
  for (uint i = lane; i < kHoleCellsPerChunk; i += 64u) hole_cells[first + i] = 0u;
}
