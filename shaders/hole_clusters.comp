// Which holes of its tile the rays of each group of pixels may meet, slice by slice: the lists of shared/hole_clusters.h.
// A workgroup for 2 x 2 groups.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#include "shared/frame.h"

layout(local_size_x = 128) in;
layout(scalar, binding = 0) uniform Frame { FrameConstants frame; };
layout(binding = 1) readonly buffer Holes { vec4 hole_rows[]; };
layout(scalar, binding = 2) readonly buffer TileHoles { uint coarse_tile_holes[]; };
layout(scalar, binding = 3) writeonly buffer HoleLists { uint hole_lists[]; };
layout(scalar, binding = 4) coherent buffer Counter { uint words_taken; };
layout(push_constant, scalar) uniform Impulse { HoleListsParams params; };
#include "lib/hole_rows.glsl"
#include "lib/hole_slices.glsl"
#include "lib/ray_cone.glsl"

const uint kThreads = gl_WorkGroupSize.x;
const uint kGroups = 4u;  // of a workgroup
const uint kLists = kGroups * kHoleSlices;
/// Holes of the tile that are looked at together: each group gets a block for them. With what they take, a workgroup keeps
/// to the 16 KiB of shared memory that every device has.
const uint kChunk = 416u;
const uint kRun = kMaxHoles / 32u / kThreads;  // words of the tile's mask that a thread takes at most

shared uint chunk[kChunk];  // holes, rising
// Which of those are in which list: 32 a word, lists side by side.
shared uint members[kChunk / 32u * kLists];
shared uint sums[kThreads];
shared uint sums8[kThreads / 8u];
shared uint words_of_lists, used_groups, first_word;

/// How many holes the threads below the lane have, and all together.
uvec2 count_before(uint lane, uint own) {
  sums[lane] = own;
  barrier();
  if (lane < kThreads / 8u) {
    uint sum = 0u;
    for (uint i = 0u; i < 8u; ++i) sum += sums[8u * lane + i];
    sums8[lane] = sum;
  }
  barrier();
  uint before = 0u, all = 0u;
  for (uint i = 0u; i < kThreads / 8u; ++i) {
    before += i < lane / 8u ? sums8[i] : 0u;
    all += sums8[i];
  }
  for (uint i = lane & ~7u; i < lane; ++i) before += sums[i];
  return uvec2(before, all);
}

/// Puts the holes of the chunk that the lane's group meets into the lists of the slices where it does.
void find_members(uint lane, uint count, RayCone cone) {
  const HoleSlices slices = hole_slices();
  // More than what rounding may move a sample.
  const float slack = 1e-3 / slices.per_metre + 1e-4;
  for (uint i = lane / kGroups; i < count; i += kThreads / kGroups) {
    const vec2 interval = cone_in_hole(cone, reach_from_rows(chunk[i]));
    if (interval.x > interval.y) continue;
    const uint first = slice_at(slices, interval.x - slack), last = slice_at(slices, interval.y + slack);
    const uint at = i / 32u * kLists + lane % kGroups;
    for (uint slice = first; slice <= last; ++slice) atomicOr(members[at + kGroups * slice], 1u << (i & 31u));
  }
}

/// Writes the list of a slice, two holes a word.
void write_list(uint list, uint mask_count, uint to) {
  uint pending = 0u, count = 0u;
  for (uint word = 0u; word < mask_count; ++word) {
    for (uint bits = members[word * kLists + list]; bits != 0u; bits &= bits - 1u) {
      // The one before is written when it is known that another follows.
      if (count > 0u && (count & 1u) == 0u) {
        hole_lists[to] = pending;
        ++to;
        pending = 0u;
      }
      pending |= chunk[32u * word + uint(findLSB(bits))] << (16u * (count & 1u));
      ++count;
    }
  }
  hole_lists[to] = pending | kLastInSlice << (16u * ((count - 1u) & 1u));
}

/// Writes the blocks of the chunk. `own` is the word of the group of the first lanes, `last` its last block.
bool write_chunks(uint lane, uint count, inout uint own, inout uint last) {
  const uint mask_count = mask_words(count);
  uint sizes[kLists / kThreads], offsets[kLists / kThreads];
  for (uint k = 0u; k < kLists / kThreads; ++k) {
    uint size = 0u;
    for (uint word = 0u; word < mask_count; ++word) size += bitCount(members[word * kLists + kThreads * k + lane]);
    sizes[k] = (size + 1u) / 2u;
    offsets[k] = size > 0u ? atomicAdd(words_of_lists, sizes[k]) : 0u;
    if (size > 0u) atomicOr(used_groups, 1u << (lane % kGroups));
  }
  barrier();
  const uint used = used_groups, blocks = kChunkWords * bitCount(used);
  if (used == 0u) return true;
  // When all is taken the sum stays, lest it should wrap.
  if (lane == 0u) first_word = words_taken < params.entry_capacity ? atomicAdd(words_taken, blocks + words_of_lists) : words_taken;
  barrier();
  const bool room = first_word + blocks + words_of_lists <= params.entry_capacity;
  const uint group = lane % kGroups, first = frame.holes.entries_at + first_word;
  const uint block = first + kChunkWords * bitCount(used & ((1u << group) - 1u));
  const bool in_use = (used >> group & 1u) != 0u;
  if (lane < kGroups && in_use) {
    if (room && last != 0u) hole_lists[last + kHoleSlices] = block;
    own = !room ? kTestAllHoles : last != 0u ? own | kMoreChunks : block;
    last = block;
    if (room) hole_lists[block + kHoleSlices] = 0u;
  }
  for (uint k = 0u; room && in_use && k < kLists / kThreads; ++k) {
    const uint list = kThreads * k + lane, to = first + blocks + offsets[k];
    hole_lists[block + list / kGroups] = sizes[k] > 0u ? to : 0u;
    if (sizes[k] > 0u) write_list(list, mask_count, to);
  }
  return room;
}

void main() {
  const uint lane = gl_LocalInvocationID.x, words = mask_words(frame.holes.count);
  const uvec2 group = 2u * gl_WorkGroupID.xy + uvec2(lane & 1u, lane >> 1u & 1u);
  const uvec2 tile = group / kCoarseTileTiles;
  const uint of_tile = (tile.x + frame.holes.tiles_across / kCoarseTileTiles * tile.y) * words;

  // Each thread a run of words, so that the lists rise.
  const uint run = (words + kThreads - 1u) / kThreads, first = min(lane * run, words);
  uint bits[kRun], own_count = 0u;
  for (uint i = 0u; i < kRun; ++i) {
    bits[i] = i < run && first + i < words ? coarse_tile_holes[of_tile + first + i] : 0u;
    own_count += bitCount(bits[i]);
  }
  const uvec2 before_all = count_before(lane, own_count);
  const vec2 low_px = vec2(group * kHoleTilePixels);
  const RayCone cone = cone_of_pixels(low_px, low_px + float(kHoleTilePixels), smoke_reach().y);

  uint own = 0u, last = 0u;
  bool room = true;
  for (uint begin = 0u; begin < before_all.y && room; begin += kChunk) {
    const uint count = min(before_all.y - begin, kChunk);
    for (uint i = lane; i < mask_words(count) * kLists; i += kThreads) members[i] = 0u;
    if (lane == 0u) words_of_lists = used_groups = 0u;
    uint rank = before_all.x;
    for (uint i = 0u; i < kRun; ++i) {
      for (uint rest = bits[i]; rest != 0u; rest &= rest - 1u) {
        if (rank >= begin && rank < begin + count) chunk[rank - begin] = 32u * (first + i) + uint(findLSB(rest));
        ++rank;
      }
    }
    barrier();
    find_members(lane, count, cone);
    barrier();
    room = write_chunks(lane, count, own, last);
    barrier();
  }
  if (lane < kGroups) hole_lists[group.x + frame.holes.tiles_across * group.y] = own;
}
