// Compact coding of voxel sets: block positions as gaps, their 64-bit masks bit by bit, each bit predicted
// from already coded neighbours within the block and across blocks.
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

/// Adaptive models shared by the sets of one packet.
struct BlockModels {
  NumberModel count;
  std::array<BitModel, 4> next_in_row;  // by presence of that block in the previous row and slice
  NumberModel gap_x, gap_y, gap_z;      // forwards, from the previous block
  std::array<NumberModel, 3> first;     // signed, from a point both sides know
  NumberModel row_x, slice_x, slice_y;  // signed, from the start of the previous row or slice
  std::array<BitModel, 512> mask;       // by the known neighbours
  std::array<BitModel, 32>
      predicted_mask;  // by prediction, what the voxel was like, how the neighbours changed
};

/// Adaptive models of per-voxel numbers.
struct DensityModels {
  std::array<NumberModel, 3> step;  // by how well the neighbours agree
  NumberModel against_expected;
};
struct DelayModels {
  std::array<BitModel, 4> none;  // by group, and whether the previous delay was 0
  std::array<NumberModel, 2> step;
};

/// A set that both sides know and that predicts the coded one: most voxels of one are in the other.
struct Prediction {
  const sim::BlockSet* set = nullptr;
  unsigned kind = 0;  ///< 0 or 1: predictions of one kind share their models.
};

/// Which blocks, and which of their voxels, are allowed.
struct BlockBounds {
  glm::ivec3 size{0};            ///< Voxels per axis of the grid.
  bool whole_blocks = false;     ///< The last blocks may have bits outside the grid.
  std::uint64_t max_voxels = 0;  ///< Maximum of the set, as counted by cost_of.
};

/// Voxels of a block, at least 16, so that a limit on voxels also bounds the blocks.
inline std::uint64_t cost_of(const sim::VoxelBlock& block) {
  return std::max<std::uint64_t>(16, static_cast<std::uint64_t>(std::popcount(block.mask)));
}

/// Codes blocks sorted by block_before, all distinct, no mask 0 (VoxelBlock::first is ignored). Blocks near
/// the block `near` are cheapest. A decoder fails on blocks outside of the bounds and on too many voxels; its
/// result is always sorted and without empty masks. Each block costs bits, so the bytes read bound the
/// memory.
template <typename Coder>
void code_blocks(Coder& coder, BlockModels& models, const BlockBounds& bounds, glm::ivec3 near,
                 const Prediction& like, std::vector<sim::VoxelBlock>& blocks);

/// Codes a number for each voxel of a set, by rank, predicted by `expected`, or if that is empty by the
/// voxel's neighbours. A decoder resizes `densities` to the set.
template <typename Coder>
void code_densities(Coder& coder, DensityModels& models, const sim::BlockSet& set,
                    std::span<const std::uint8_t> expected, std::vector<std::uint8_t>& densities);

/// Codes a delay for each rank in an order both sides know: 0, or near the last one that was not 0. Ranks
/// with `group` 0 and the others are predicted separately. All lists have the same length.
template <typename Coder>
void code_delays(Coder& coder, DelayModels& models, std::span<const std::uint32_t> order,
                 std::span<const std::uint8_t> group, std::vector<std::uint16_t>& delays);

/// Zigzag coding: 0, -1, 1, -2, ... to 0, 1, 2, 3, ...
constexpr std::uint64_t folded(std::int64_t value) {
  return static_cast<std::uint64_t>(value) << 1 ^ static_cast<std::uint64_t>(value >> 63);
}
constexpr std::int64_t unfolded(std::uint64_t value) {
  return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
}

}  // namespace brume::wire
