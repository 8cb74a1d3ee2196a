// Which holes of its tile the rays of a group of pixels may meet, and where. A workgroup a group.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/frame.h"

layout(local_size_x = kHoleSlabs) in;
layout(scalar, binding = 0) readonly buffer Frame { FrameConstants frame; };
layout(binding = 1) readonly buffer Holes { vec4 hole_rows[]; };
layout(scalar, binding = 2) readonly buffer TileHoles { uint tile_holes[]; };
layout(scalar, binding = 3) coherent buffer HoleLists { uint hole_lists[]; };
layout(scalar, binding = 4) buffer Counters { HoleCounters counters; };
layout(push_constant, scalar) uniform Push { HoleListsParams params; };
#include "lib/hole_rows.glsl"
#include "lib/hole_slabs.glsl"
#include "lib/ray_cone.glsl"

shared uint counts[kHoleSlabs];
shared uint first_of_group;

/// Counts the holes of the lane's share of the tile's, and writes them where `write` says so.
uint list_holes(uint first_word, uint end_word, RayCone cone, bool write, uint at) {
  const HoleSlabs slabs = hole_slabs();
  // More than what rounding may move a sample.
  const float slack = 1e-3 / slabs.per_metre + 1e-4;
  const uint tiles_across = frame.holes.groups_across / kHoleTileGroups;
  const uvec2 tile = gl_WorkGroupID.xy / kHoleTileGroups;
  const uint of_tile = (tile.x + tiles_across * tile.y) * mask_words(frame.holes.count);
  uint count = 0u;
  for (uint word = first_word; word < end_word; ++word) {
    for (uint bits = tile_holes[of_tile + word]; bits != 0u; bits &= bits - 1u) {
      const uint hole = 32u * word + uint(findLSB(bits));
      const vec2 interval = cone_in_hole(cone, reach_from_rows(hole));
      if (interval.x > interval.y) continue;
      const uint first = slab_at(slabs, interval.x - slack), last = slab_at(slabs, interval.y + slack);
      if (write) hole_lists[at + count] = hole | first << 16u | last << 24u;
      ++count;
    }
  }
  return count;
}

void main() {
  const uint lane = gl_LocalInvocationID.x;
  const vec2 low_px = vec2(gl_WorkGroupID.xy * kHoleGroupPixels);
  const RayCone cone = cone_of_pixels(low_px, low_px + float(kHoleGroupPixels), smoke_reach().y);
  // Each lane a run of words, so that the list rises.
  const uint words = mask_words(frame.holes.count), run = (words + kHoleSlabs - 1u) / kHoleSlabs;
  const uint first_word = min(lane * run, words), end_word = min(first_word + run, words);
  counts[lane] = list_holes(first_word, end_word, cone, false, 0u);
  barrier();
  uint before = 0u, count = 0u;
  for (uint i = 0u; i < kHoleSlabs; ++i) {
    before += i < lane ? counts[i] : 0u;
    count += counts[i];
  }
  const uint room = count + kHoleSlabs * mask_words(count);
  if (lane == 0u) {
    first_of_group = count > 0u ? atomicAdd(counters.entries, room) : 0u;
    const uint list = 2u * (gl_WorkGroupID.x + frame.holes.groups_across * gl_WorkGroupID.y);
    hole_lists[list] = frame.holes.entries_at + first_of_group;
    hole_lists[list + 1u] = first_of_group + room <= params.entry_capacity ? count : kAskAllHoles;
  }
  barrier();
  if (count == 0u || first_of_group + room > params.entry_capacity) return;
  const uint entries = frame.holes.entries_at + first_of_group;
  list_holes(first_word, end_word, cone, true, entries + before);
  memoryBarrierBuffer();
  barrier();

  // A lane a slab.
  for (uint word = 0u; word < mask_words(count); ++word) {
    uint bits = 0u;
    for (uint i = 32u * word; i < min(32u * word + 32u, count); ++i) {
      const uint entry = hole_lists[entries + i];
      if ((entry >> 16u & 255u) <= lane && lane <= entry >> 24u) bits |= 1u << (i & 31u);
    }
    hole_lists[entries + count + mask_words(count) * lane + word] = bits;
  }
}
