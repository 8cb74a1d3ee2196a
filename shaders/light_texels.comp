// Lists the texels of a brick whose light is needed, since smoke is around them. One workgroup a brick.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/frame.h"
#include "shared/smoke_light.h"

layout(local_size_x = 256) in;
layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(scalar, binding = 1) readonly buffer Bricks { LightRow bricks[]; };
layout(binding = 2) uniform sampler3D density_atlas;
layout(scalar, binding = 3) writeonly buffer Rows { uint rows[]; };
layout(scalar, binding = 4) readonly buffer Cells { uint cells[]; };
layout(push_constant, scalar) uniform Push { SmokeLightParams params; };

// What samples may take from a texel: from smoke in it, or from a cell at a wall that it is a corner of.
const uint kSmoke = 1u;
const uint kWall = 2u;

shared uint needed[kTexelsPerBrick];
shared uint grown[kTexelsPerBrick];
shared uint texel_count;

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

void main() {
  const uint number = gl_WorkGroupID.x + kLightGroups * gl_WorkGroupID.y;
  if (number >= params.count) return;
  const LightRow brick = bricks[params.first + number];
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
  if (lane == 0u) texel_count = 0u;
  barrier();
  const uint first = brick.row * kLightRow;
  for (uint i = lane; i < kTexelsPerBrick; i += 256u) {
    if (around(false, i, 100u) > 0u) rows[first + 1u + atomicAdd(texel_count, 1u)] = i;
  }
  barrier();
  if (lane == 0u) rows[first] = texel_count;
}
