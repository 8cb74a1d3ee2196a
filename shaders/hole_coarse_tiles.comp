// Finds the holes that the rays of each coarse tile may meet. One workgroup per coarse tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "lib/frame.glsl"
#include "shared/hole_clusters.h"

layout(local_size_x = 256) in;
layout(scalar, binding = kBindCoarseTileHoles) writeonly buffer TileHoles { uint coarse_tile_holes[]; };
#include "lib/hole_reaches.glsl"
#include "lib/hole_slices.glsl"
#include "lib/ray_cone.glsl"

shared uint met[kMaxHoles / 32u];

void main() {
  const uint lane = gl_LocalInvocationID.x, words = mask_words(frame.holes.count);
  for (uint word = lane; word < words; word += gl_WorkGroupSize.x) met[word] = 0u;
  barrier();
  const float tile_px = float(kCoarseTileTiles * kHoleTilePixels);
  const vec2 low_px = vec2(gl_WorkGroupID.xy) * tile_px;
  const RayCone cone = cone_of_pixels(low_px, low_px + tile_px, smoke_reach().y);
  for (uint i = lane; i < frame.holes.count; i += gl_WorkGroupSize.x) {
    const vec2 interval = cone_in_hole(cone, reach_at(i));
    if (interval.x <= interval.y) atomicOr(met[i >> 5u], 1u << (i & 31u));
  }
  barrier();
  const uint tile = gl_WorkGroupID.x + gl_NumWorkGroups.x * gl_WorkGroupID.y;
  for (uint word = lane; word < words; word += gl_WorkGroupSize.x) coarse_tile_holes[tile * words + word] = met[word];
}
