// Finds the holes of its coarse tile that the rays of each tile may meet, slice by slice: the lists of
// shared/hole_clusters.h. One workgroup per 2 x 2 tiles.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "lib/frame.glsl"
#include "shared/hole_clusters.h"

layout(local_size_x = 128) in;
layout(scalar, binding = kBindCoarseTileHoles) readonly buffer TileHoles { uint coarse_tile_holes[]; };
layout(scalar, binding = kBindHoleLists) writeonly buffer HoleLists { uint hole_lists[]; };
layout(scalar, binding = kBindHoleWordsTaken) coherent buffer Counter { uint words_taken; };
layout(scalar, push_constant) uniform Push { HoleListsParams params; };
#include "lib/hole_reaches.glsl"
#include "lib/hole_slices.glsl"
#include "lib/ray_cone.glsl"

const uint kThreads = gl_WorkGroupSize.x;
const uint kTiles = 4u;  // of a workgroup
const uint kLists = kTiles * kHoleSlices;
/// Holes of the coarse tile per pass of the loop, which gives each tile one chunk. Limited by the 16 KiB of shared
/// memory that every device has.
const uint kBatch = 416u;
const uint kRun = kMaxHoles / 32u / kThreads;  // words of the coarse tile's mask per thread, at most

shared uint batch[kBatch];  // holes, ascending
// A mask of the batch per list: 32 holes per word, lists interleaved.
shared uint members[kBatch / 32u * kLists];
shared uint sums[kThreads];
shared uint words_of_lists, used_tiles, first_word;

/// Exclusive prefix sum over the lanes, and the total.
uvec2 count_before(uint own) {
  const uint of_subgroup = subgroupAdd(own);
  if (subgroupElect()) sums[gl_SubgroupID] = of_subgroup;
  barrier();
  uint before = subgroupExclusiveAdd(own), all = 0u;
  for (uint i = 0u; i < gl_NumSubgroups; ++i) {
    before += i < gl_SubgroupID ? sums[i] : 0u;
    all += sums[i];
  }
  return uvec2(before, all);
}

/// Adds the holes of the batch that the lane's tile meets to the lists of the slices where it meets them.
void find_members(uint lane, uint count, RayCone cone) {
  const HoleSlices slices = hole_slices();
  // More than rounding may move a sample.
  const float slack = 1e-3 / slices.per_metre + 1e-4;
  for (uint i = lane / kTiles; i < count; i += kThreads / kTiles) {
    const vec2 interval = cone_in_hole(cone, reach_at(batch[i]));
    if (interval.x > interval.y) continue;
    const uint first = slice_at(slices, interval.x - slack), last = slice_at(slices, interval.y + slack);
    const uint at = i / 32u * kLists + lane % kTiles;
    for (uint slice = first; slice <= last; ++slice) atomicOr(members[at + kTiles * slice], 1u << (i & 31u));
  }
}

/// Writes the list of a slice, two holes a word.
void write_list(uint list, uint mask_count, uint to) {
  uint pending = 0u, count = 0u;
  for (uint word = 0u; word < mask_count; ++word) {
    for (uint bits = members[word * kLists + list]; bits != 0u; bits &= bits - 1u) {
      // A word is written once another follows it: the last one gets an end mark.
      if (count > 0u && (count & 1u) == 0u) {
        hole_lists[to] = pending;
        ++to;
        pending = 0u;
      }
      pending |= batch[32u * word + uint(findLSB(bits))] << (16u * (count & 1u));
      ++count;
    }
  }
  hole_lists[to] = pending | kLastInSlice << (16u * ((count - 1u) & 1u));
}

/// Writes the chunks of the batch. `own` is the word of the lane's tile, `last` its last chunk. False when they do not
/// fit.
bool write_chunks(uint lane, uint count, inout uint own, inout uint last) {
  const uint mask_count = mask_words(count);
  uint sizes[kLists / kThreads], offsets[kLists / kThreads];
  for (uint k = 0u; k < kLists / kThreads; ++k) {
    uint size = 0u;
    for (uint word = 0u; word < mask_count; ++word) size += bitCount(members[word * kLists + kThreads * k + lane]);
    sizes[k] = (size + 1u) / 2u;
    offsets[k] = size > 0u ? atomicAdd(words_of_lists, sizes[k]) : 0u;
    if (size > 0u) atomicOr(used_tiles, 1u << (lane % kTiles));
  }
  barrier();
  const uint used = used_tiles, chunk_words = kChunkWords * bitCount(used);
  if (used == 0u) return true;
  // Stops counting once full, so that the sum cannot wrap.
  if (lane == 0u) {
    const bool full = words_taken >= params.entry_capacity;
    first_word = full ? words_taken : atomicAdd(words_taken, chunk_words + words_of_lists);
  }
  barrier();
  const bool room = first_word + chunk_words + words_of_lists <= params.entry_capacity;
  const uint tile = lane % kTiles, first = frame.holes.entries_at + first_word;
  const uint chunk = first + kChunkWords * bitCount(used & ((1u << tile) - 1u));
  const bool in_use = (used >> tile & 1u) != 0u;
  if (lane < kTiles && in_use) {
    if (room && last != 0u) hole_lists[last + kHoleSlices] = chunk;
    own = !room ? kTestAllHoles : last != 0u ? own | kMoreChunks : chunk;
    last = chunk;
    if (room) hole_lists[chunk + kHoleSlices] = 0u;
  }
  for (uint k = 0u; room && in_use && k < kLists / kThreads; ++k) {
    const uint list = kThreads * k + lane, to = first + chunk_words + offsets[k];
    hole_lists[chunk + list / kTiles] = sizes[k] > 0u ? to : 0u;
    if (sizes[k] > 0u) write_list(list, mask_count, to);
  }
  return room;
}

void main() {
  const uint lane = gl_SubgroupID * gl_SubgroupSize + gl_SubgroupInvocationID, words = mask_words(frame.holes.count);
  const uvec2 tile = 2u * gl_WorkGroupID.xy + uvec2(lane & 1u, lane >> 1u & 1u);
  const uvec2 coarse = tile / kCoarseTileTiles;
  const uint first_mask = (coarse.x + frame.holes.tiles_across / kCoarseTileTiles * coarse.y) * words;

  // A run of words per thread keeps the lists ascending.
  const uint run = (words + kThreads - 1u) / kThreads, first = min(lane * run, words);
  uint bits[kRun], own_count = 0u;
  for (uint i = 0u; i < kRun; ++i) {
    bits[i] = i < run && first + i < words ? coarse_tile_holes[first_mask + first + i] : 0u;
    own_count += bitCount(bits[i]);
  }
  const uvec2 before_all = count_before(own_count);
  const vec2 low_px = vec2(tile * kHoleTilePixels);
  const RayCone cone = cone_of_pixels(low_px, low_px + float(kHoleTilePixels), smoke_reach().y);

  uint own = 0u, last = 0u;
  bool room = true;
  for (uint begin = 0u; begin < before_all.y && room; begin += kBatch) {
    const uint count = min(before_all.y - begin, kBatch);
    for (uint i = lane; i < mask_words(count) * kLists; i += kThreads) members[i] = 0u;
    if (lane == 0u) words_of_lists = used_tiles = 0u;
    uint rank = before_all.x;
    for (uint i = 0u; i < kRun; ++i) {
      for (uint rest = bits[i]; rest != 0u; rest &= rest - 1u) {
        if (rank >= begin && rank < begin + count) batch[rank - begin] = 32u * (first + i) + uint(findLSB(rest));
        ++rank;
      }
    }
    barrier();
    find_members(lane, count, cone);
    barrier();
    room = write_chunks(lane, count, own, last);
    barrier();
  }
  if (lane < kTiles) hole_lists[tile.x + frame.holes.tiles_across * tile.y] = own;
}
