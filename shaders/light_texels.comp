// Lists the texels of a brick whose light samples may read: those near smoke. One workgroup per brick.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "shared/light_side.h"
#include "shared/smoke_light.h"

layout(local_size_x = 256) in;
layout(scalar, binding = kBindTexelLists) readonly buffer Bricks { TexelList bricks[]; };
layout(binding = kBindDensity) uniform sampler3D density_atlas;
layout(scalar, binding = kBindLightRows) buffer Rows { uint rows[]; };
layout(scalar, binding = kBindCells) readonly buffer Cells { uint cells[]; };
layout(binding = kBindInscatter, rgba16f) uniform writeonly image3D inscatter;
layout(binding = kBindLightSide, rgba16f) uniform writeonly image3D light_side;
layout(scalar, binding = kBindLightChanges) readonly buffer Changes { LightChange changes[]; };
layout(scalar, push_constant) uniform Push { SmokeLightParams params; };
#include "lib/smoke_texels.glsl"

// Why samples may read around a texel: smoke in it, or a boundary cell of which it is a corner.
const uint kSmoke = 1u;
const uint kWall = 2u;

shared uint marked[kTexelsPerBrick];  // later the list
shared uint grown[kTexelsPerBrick];
shared uint phase_count[kLightPhases];
shared uint new_count;

// Flags of a texel in `grown` at the end: in the list, in the previous list.
const uint kListed = 1u;
const uint kWasListed = 2u;

/// Whether the texel is a corner of a boundary cell, whose density may come from voxels outside of the brick.
bool at_boundary(uint slot, ivec3 local) {
  uint any_cell = 0u;
  for (int corner = 0; corner < 8; ++corner) {
    const ivec3 cell = local - ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, ivec3(kBrickCells)))) continue;
    any_cell |= cells[slot * kCellsPerBrick + uint(cell.x + kBrickCells * (cell.y + kBrickCells * cell.z))];
  }
  return any_cell != 0u;
}

/// Flags around texel i along an axis: smoke within one texel, walls within two, because lookups near walls are moved
/// by up to a voxel.
uint around(bool of_grown, uint i, uint stride) {
  const int at = int(i / stride % 10u);
  uint found = 0u;
  for (int k = max(at - 2, 0); k <= min(at + 2, 9); ++k) {
    const uint j = uint(int(i) + (k - at) * int(stride)), flags = of_grown ? grown[j] : marked[j];
    found |= abs(k - at) < 2 ? flags : flags & kWall;
  }
  return found;
}

uint phase_of(bool by_phase, uint texel) { return by_phase ? light_phase(uvec3(local_texel(texel))) : 0u; }

bool in_change(TexelList brick, uint texel) {
  const vec3 p = world_from_voxel(texel_position(brick.slot, texel));
  bool within = false;
  for (uint i = brick.first_change; i < brick.first_change + brick.change_count; ++i) {
    const LightChange change = changes[i];
    const vec3 segment = change.to_world - change.from_world, from = p - change.from_world;
    const vec3 offset = from - segment * clamp(dot(from, segment) / max(dot(segment, segment), 1e-9), 0.0, 1.0);
    within = within || dot(offset, offset) < change.radius * change.radius;
  }
  return within;
}

/// Writes the list of the texels marked in `grown`. Runs in all threads of the workgroup.
void write_list(TexelList brick, uint lane) {
  const uint head = brick.row * kTexelListWords;
  const bool by_phase = brick.by_phase != 0u;
  if (lane < kLightPhases) phase_count[lane] = 0u;
  if (lane == 0u) new_count = 0u;
  for (uint i = lane; i < kTexelsPerBrick; i += 256u) marked[i] = 0u;
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
  // The two halves of a word are written by different threads.
  for (uint i = lane; i < kTexelsPerBrick; i += 256u) {
    if ((grown[i] & kListed) == 0u) continue;
    atomicOr(marked[atomicAdd(phase_count[phase_of(by_phase, i)], 1u)], i);
    if (brick.had_list != 0u && grown[i] == kListed) atomicOr(marked[atomicAdd(new_count, 1u)], i << 16u);
  }
  barrier();
  if (lane == 0u) rows[head + kLightPhases + 1u] = new_count;
  for (uint i = lane; i < kTexelsPerBrick; i += 256u) rows[head + kTexelListHead + i] = marked[i];
}

void main() {
  const uint number = gl_WorkGroupID.x + kLightGroups * gl_WorkGroupID.y;
  if (number >= params.count) return;
  const TexelList brick = bricks[params.first + number];
  const uint lane = gl_LocalInvocationID.x;

  for (uint i = lane; i < kTexelsPerBrick; i += 256u) {
    const bool smoke = texelFetch(density_atlas, texel_in_atlas(brick.slot, i), 0).r > 0.0;
    marked[i] = (smoke ? kSmoke : 0u) | (at_boundary(brick.slot, local_texel(i)) ? kWall : 0u);
  }
  barrier();
  for (uint i = lane; i < kTexelsPerBrick; i += 256u) grown[i] = around(false, i, 1u);
  barrier();
  for (uint i = lane; i < kTexelsPerBrick; i += 256u) marked[i] = around(true, i, 10u);
  barrier();
  for (uint i = lane; i < kTexelsPerBrick; i += 256u) grown[i] = around(false, i, 100u) > 0u ? kListed : 0u;
  barrier();
  const uint head = brick.row * kTexelListWords;
  const uint before = brick.had_list != 0u ? rows[head + kLightPhases] : 0u;
  for (uint i = lane; i < before; i += 256u) {
    const uint texel = rows[head + kTexelListHead + i] & 0xffffu;
    if (!in_change(brick, texel)) atomicOr(grown[texel], kWasListed);
  }
  // Where light is unknown; what interpolates it beyond the list can tell.
  for (uint i = lane; i < kTexelsPerBrick; i += 256u)
    if ((grown[i] & kListed) == 0u) {
      imageStore(inscatter, texel_in_atlas(brick.slot, i), vec4(0.0));
      imageStore(light_side, texel_in_atlas(brick.slot, i), vec4(0.0));
    }
  barrier();
  write_list(brick, lane);
}
