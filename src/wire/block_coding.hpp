// Sets of voxels coded small: where the blocks are as gaps, their 64-bit masks bit by bit, each bit foretold
// by neighbours that are already known, within the block and across blocks.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>
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
  std::array<BitModel, 1024> mask;      // by the known neighbours
};

/// What numbers of voxels have in common so far: models by how well the neighbours agree.
using StepModels = std::array<NumberModel, 3>;

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
                 std::vector<sim::VoxelBlock>& blocks);

/// Codes a number for each voxel of a set, by rank; a decoder finds `steps` empty and sizes it to the set.
template <typename Coder, typename Step>
void code_steps(Coder& coder, StepModels& models, const sim::BlockSet& set, std::vector<Step>& steps);

/// 0, -1, 1, -2, ... to 0, 1, 2, 3, ...
constexpr std::uint64_t folded(std::int64_t value) {
  return static_cast<std::uint64_t>(value) << 1 ^ static_cast<std::uint64_t>(value >> 63);
}
constexpr std::int64_t unfolded(std::uint64_t value) {
  return static_cast<std::int64_t>(value >> 1) ^ -static_cast<std::int64_t>(value & 1);
}

}  // namespace brume::wire
