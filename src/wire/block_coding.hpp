// Sets of voxels coded small: where the blocks are as gaps, their 64-bit masks bit by bit, each bit foretold
// by neighbours that are already known, within the block and across blocks.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "sim/block_set.hpp"
#include "wire/range_coder.hpp"

namespace brume::wire {

/// What the sets of one packet have in common so far.
struct BlockModels {
  NumberModel count;
  std::array<BitModel, 4> next_in_row;  // by: a block there in the row before, in the slice before
  NumberModel gap_x, gap_y, gap_z;      // forwards, from the block before
  std::array<NumberModel, 3> first;     // signed, from a point that both sides know
  NumberModel row_x, slice_x, slice_y;  // signed, from where the row or slice before began
  std::array<BitModel, 512> mask;       // by the known neighbours
  std::array<BitModel, 32> predicted_mask;   // by prediction, what the voxel was like, how the neighbours changed
};

/// What numbers of voxels have in common so far.
struct DensityModels {
  std::array<NumberModel, 3> step;  // by how well the neighbours agree
  NumberModel against_expected;
};
struct DelayModels {
  std::array<BitModel, 4> none;  // by group, and whether the one before had none
  std::array<NumberModel, 2> step;
};

/// A set that both sides know and that the coded one is like: voxels of one are mostly in the other.
struct Prediction {
  const sim::BlockSet* set = nullptr;
  unsigned kind = 0;  ///< 0 or 1: likenesses of one kind share what was learnt.
};

/// Where blocks may lie: [0, end), and which of their voxels are allowed.
struct BlockBounds {
  glm::ivec3 size{0};            ///< Voxels per axis of the grid.
  bool whole_blocks = false;     ///< Bits beyond the grid, in its last blocks, are allowed.
  std::uint64_t max_voxels = 0;  ///< Of the set, as cost_of counts them.
};

/// Voxels of a block, at least 16: so that a limit on them bounds the blocks too.
inline std::uint64_t cost_of(const sim::VoxelBlock& block) {
  return std::max<std::uint64_t>(16, static_cast<std::uint64_t>(std::popcount(block.mask)));
}

/// Codes blocks sorted by block_before, no two alike, no mask 0 (VoxelBlock::first is not looked at). Blocks
/// near `near` (a block) come cheapest. A decoder fails on blocks outside of the bounds and on too many
/// voxels; what it hands back is sorted and without empty masks always. Each block costs bits, so that memory
/// is bounded by the bytes read.
template <typename Coder>
void code_blocks(Coder& coder, BlockModels& models, const BlockBounds& bounds, glm::ivec3 near,
                 const Prediction& like, std::vector<sim::VoxelBlock>& blocks);

/// Codes a number for each voxel of a set, by rank: near `expected`, or where that is empty near those of its
/// neighbours. A decoder finds `densities` empty and sizes it to the set.
template <typename Coder>
void code_densities(Coder& coder, DensityModels& models, const sim::BlockSet& set,
                std::span<const std::uint8_t> expected, std::vector<std::uint8_t>& densities);

/// Codes a number for each rank, in this order of ranks, which both sides know: 0, or near the last that was
/// not 0. Ranks whose `group` is 0 mostly have alike numbers, and those of others. All of the same length.
template <typename Coder>
void code_delays(Coder& coder, DelayModels& models, std::span<const std::uint32_t> order,
                std::span<const std::uint8_t> group, std::vector<std::uint16_t>& delays);

/// 0, -1, 1, -2, ... to 0, 1, 2, 3, ...
constexpr std::uint64_t folded(std::int64_t value) {
  return static_cast<std::uint64_t>(value) << 1 ^ static_cast<std::uint64_t>(value >> 63);
}
constexpr std::int64_t unfolded(std::uint64_t value) {
  return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
}

}  // namespace brume::wire
