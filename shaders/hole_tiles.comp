// Which holes the rays of each tile of the picture may meet. One workgroup a tile.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/frame.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(binding = 1) readonly buffer Holes { vec4 hole_rows[]; };
layout(scalar, binding = 2) writeonly buffer HoleTiles { uint hole_tiles[]; };

#include "lib/hole_rows.glsl"
#include "lib/ray_cone.glsl"

shared uint bits[kMaxHoles / 32u];

void main() {
  const uint lane = gl_LocalInvocationID.x;
  for (uint i = lane; i < frame.holes.tile_words; i += 64u) bits[i] = 0u;
  barrier();
  const vec2 low_px = vec2(gl_WorkGroupID.xy * kHoleTilePixels);
  const RayCone cone = cone_of_pixels(low_px, low_px + float(kHoleTilePixels), smoke_reach());
  for (uint i = lane; i < frame.holes.count; i += 64u) {
    if (cone_meets_hole(cone, hole_reach(hole_from_rows(i), frame.time, frame.look.hole_rim))) {
      atomicOr(bits[i >> 5u], 1u << (i & 31u));
    }
  }
  barrier();
  const uint first = frame.holes.tile_words * (gl_WorkGroupID.x + frame.holes.tiles_across * gl_WorkGroupID.y);
  for (uint i = lane; i < frame.holes.tile_words; i += 64u) hole_tiles[first + i] = bits[i];
}
