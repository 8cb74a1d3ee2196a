// Which holes the rays of each 8 x 8 pixels may meet. One workgroup for 8 x 8 of those groups: first the holes of all of
// them, then each thread those of a group.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/frame.h"

layout(local_size_x = 64) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(binding = 1) readonly buffer Holes { vec4 hole_rows[]; };
layout(scalar, binding = 2) writeonly buffer HoleLists { uint hole_lists[]; };
layout(scalar, binding = 3) buffer Counters { HoleCounters counters; };
layout(push_constant, scalar) uniform Push { HoleListsParams params; };
#include "lib/hole_rows.glsl"
#include "lib/hole_slabs.glsl"
#include "lib/ray_cone.glsl"

shared uint bits[kMaxHoles / 32u];
shared uint tile_entries;
shared uint tile_first;

/// Counts the tile's holes that the cone meets, and writes those below `room` from `at` on.
uint list_holes(RayCone cone, uint at, uint room) {
  uint count = 0u;
  for (uint word = 0u; 32u * word < frame.holes.count; ++word) {
    for (uint some = bits[word]; some != 0u; some &= some - 1u) {
      const uint hole = 32u * word + uint(findLSB(some));
      if (!cone_meets_hole(cone, hole_reach(hole_from_rows(hole), frame.time, frame.look.hole_rim))) continue;
      if (count < room) hole_lists[at + count] = hole;
      ++count;
    }
  }
  return count;
}

void main() {
  const uint lane = gl_LocalInvocationID.x, tile_px = 8u * kHoleGroupPixels;
  for (uint i = lane; 32u * i < frame.holes.count; i += 64u) bits[i] = 0u;
  if (lane == 0u) tile_entries = 0u;
  barrier();
  const vec2 low_px = vec2(gl_WorkGroupID.xy * tile_px);
  const RayCone cone = cone_of_pixels(low_px, low_px + float(tile_px), smoke_reach().y);
  for (uint i = lane; i < frame.holes.count; i += 64u) {
    if (cone_meets_hole(cone, hole_reach(hole_from_rows(i), frame.time, frame.look.hole_rim))) {
      atomicOr(bits[i >> 5u], 1u << (i & 31u));
    }
  }
  barrier();

  const uvec2 group = 8u * gl_WorkGroupID.xy + uvec2(lane & 7u, lane >> 3u);
  const vec2 group_px = vec2(group * kHoleGroupPixels);
  const RayCone group_cone = cone_of_pixels(group_px, group_px + float(kHoleGroupPixels), cone.length_m);
  const uint count = list_holes(group_cone, 0u, 0u);
  const uint words = count + kHoleSlabs * mask_words(count);
  const uint before = count > 0u ? atomicAdd(tile_entries, words) : 0u;
  barrier();
  if (lane == 0u) tile_first = tile_entries > 0u ? atomicAdd(counters.entries, tile_entries) : 0u;
  barrier();
  const uint first = tile_first + before;
  const bool fits = first + words <= params.entry_capacity;
  const uint list = 2u * (group.x + frame.holes.groups_across * group.y);
  hole_lists[list] = frame.holes.entries_at + first;
  hole_lists[list + 1u] = fits ? count : kAskAllHoles;
  if (fits && count > 0u) list_holes(group_cone, frame.holes.entries_at + first, count);
}
