// Which holes may meet which tile of the picture. A thread for 32 holes and a tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/frame.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(binding = 1) readonly buffer Holes { vec4 hole_rows[]; };
layout(scalar, binding = 2) writeonly buffer TileHoles { uint tile_holes[]; };
#include "lib/hole_rows.glsl"
#include "lib/hole_slabs.glsl"
#include "lib/ray_cone.glsl"

void main() {
  const uint words = mask_words(frame.holes.count), tiles_across = frame.holes.groups_across / kHoleTileGroups;
  const uint tile = gl_GlobalInvocationID.x / words, word = gl_GlobalInvocationID.x % words;
  const uint tile_px = kHoleTileGroups * kHoleGroupPixels;
  const vec2 low_px = vec2(uvec2(tile % tiles_across, tile / tiles_across) * tile_px);
  if (low_px.y >= float(frame.size_px.y)) return;
  const RayCone cone = cone_of_pixels(low_px, low_px + float(tile_px), smoke_reach().y);
  uint bits = 0u;
  for (uint i = 32u * word; i < min(32u * word + 32u, frame.holes.count); ++i) {
    const vec2 interval = cone_in_hole(cone, reach_from_rows(i));
    if (interval.x <= interval.y) bits |= 1u << (i & 31u);
  }
  tile_holes[tile * words + word] = bits;
}
