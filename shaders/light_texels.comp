// Lists the texels of a brick whose light is needed, since smoke is around them. One workgroup a brick.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/frame.h"
#include "shared/smoke_light.h"

layout(local_size_x = 256) in;
layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer Bricks { TexelList bricks[]; };
layout(binding = 2) uniform sampler3D density_atlas;
layout(scalar, binding = 3) buffer Rows { uint rows[]; };
layout(scalar, binding = 4) readonly buffer Cells { uint cells[]; };
layout(scalar, binding = 5) readonly buffer SlotBricks { ivec3 slot_bricks[]; };
layout(scalar, binding = 6) readonly buffer Changes { LightChange changes[]; };
layout(push_constant, scalar) uniform Impulse { SmokeLightParams params; };
#include "lib/smoke_texels.glsl"

// What samples may take from a texel: from smoke in it, or from a cell at a wall that it is a corner of.
const uint kSmoke = 1u;
const uint kWall = 2u;

shared uint needed[kTexelsPerBrick];
shared uint grown[kTexelsPerBrick];
shared uint phase_count[kLightPhases];
shared uint new_count;

// Of a texel, in `grown` at the end: that the list has it, and that the list before had it.
const uint kListed = 1u;
const uint kWasListed = 2u;

/// Whether a boundary cell has the texel as a corner: its density may come from voxels that the brick does not hold.
bool at_boundary(uint slot, ivec3 local) {
  uint any_cell = 0u;
  for (int corner = 0; corner < 8; ++corner) {
    const ivec3 cell = local - ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, ivec3(kBrickCells)))) continue;
    any_cell |= cells[slot * kCellsPerBrick + uint(cell.x + kBrickCells * (cell.y + kBrickCells * cell.z))];
  }
  return any_cell != 0u;
}

/// What is around texel i along an axis: smoke within one texel, walls within two, as a lookup near them is moved by up
/// to a voxel.
uint around(bool of_grown, uint i, uint stride) {
  const int at = int(i / stride % 10u);
  uint found = 0u;
  for (int k = max(at - 2, 0); k <= min(at + 2, 9); ++k) {
    const uint j = uint(int(i) + (k - at) * int(stride)), there = of_grown ? grown[j] : needed[j];
    found |= abs(k - at) < 2 ? there : there & kWall;
  }
  return found;
}

uint phase_of(bool by_phase, uint texel) { return by_phase ? light_phase(uvec3(local_texel(texel))) : 0u; }

bool in_change(TexelList brick, uint texel) {
  const vec3 p = world_from_voxel(texel_position(brick.slot, texel));
  bool within = false;
  for (uint i = brick.first_change; i < brick.first_change + brick.change_count; ++i) {
    const LightChange change = changes[i];
    const vec3 way = change.to_world - change.from_world, from = p - change.from_world;
    const vec3 apart = from - way * clamp(dot(from, way) / max(dot(way, way), 1e-9), 0.0, 1.0);
    within = within || dot(apart, apart) < change.radius * change.radius;
  }
  return within;
}

/// Writes the list of the texels that `grown` marks. All threads of the workgroup take part.
void write_list(TexelList brick, uint lane) {
  const uint head = brick.row * kTexelListWords;
  const bool by_phase = brick.by_phase != 0u;
  if (lane < kLightPhases) phase_count[lane] = 0u;
  if (lane == 0u) new_count = 0u;
  for (uint i = lane; i < kTexelsPerBrick; i += 256u) needed[i] = 0u;
  barrier();
  for (uint i = lane; i < kTexelsPerBrick; i += 256u)
    if ((grown[i] & kListed) != 0u) atomicAdd(phase_count[phase_of(by_phase, i)], 1u);
  barrier();
  uint begin = 0u;
  if (lane == 0u) {
    for (uint phase = 0u; phase < kLightPhases; ++phase) {
      const uint count = phase_count[phase];
      rows[head + phase] = begin;
      phase_count[phase] = begin;
      begin += count;
    }
    rows[head + kLightPhases] = begin;
  }
  barrier();
  // Both halves of a word at different times.
  for (uint i = lane; i < kTexelsPerBrick; i += 256u) {
    if ((grown[i] & kListed) == 0u) continue;
    atomicOr(needed[atomicAdd(phase_count[phase_of(by_phase, i)], 1u)], i);
    if (brick.had_list != 0u && grown[i] == kListed) atomicOr(needed[atomicAdd(new_count, 1u)], i << 16u);
  }
  barrier();
  if (lane == 0u) rows[head + kLightPhases + 1u] = new_count;
  for (uint i = lane; i < kTexelsPerBrick; i += 256u) rows[head + kTexelListHead + i] = needed[i];
}

void main() {
  const uint number = gl_WorkGroupID.x + kLightGroups * gl_WorkGroupID.y;
  if (number >= params.count) return;
  const TexelList brick = bricks[params.first + number];
  const uint lane = gl_LocalInvocationID.x;
  const uvec3 atlas = uvec3(frame.volume.atlas_bricks);
  const ivec3 corner = ivec3(brick.slot % atlas.x, brick.slot / atlas.x % atlas.y, brick.slot / (atlas.x * atlas.y)) * kBrickTexels;

  for (uint i = lane; i < kTexelsPerBrick; i += 256u) {
    const ivec3 local = ivec3(i % 10u, i / 10u % 10u, i / 100u);
    needed[i] = (texelFetch(density_atlas, corner + local, 0).r > 0.0 ? kSmoke : 0u) | (at_boundary(brick.slot, local) ? kWall : 0u);
  }
  barrier();
  for (uint i = lane; i < kTexelsPerBrick; i += 256u) grown[i] = around(false, i, 1u);
  barrier();
  for (uint i = lane; i < kTexelsPerBrick; i += 256u) needed[i] = around(true, i, 10u);
  barrier();
  for (uint i = lane; i < kTexelsPerBrick; i += 256u) grown[i] = around(false, i, 100u) > 0u ? kListed : 0u;
  barrier();
  const uint head = brick.row * kTexelListWords;
  const uint before = brick.had_list != 0u ? rows[head + kLightPhases] : 0u;
  for (uint i = lane; i < before; i += 256u) {
    const uint texel = rows[head + kTexelListHead + i] & 0xffffu;
    if (!in_change(brick, texel)) atomicOr(grown[texel], kWasListed);
  }
  barrier();
  write_list(brick, lane);
}
