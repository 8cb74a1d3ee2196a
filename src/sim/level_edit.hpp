// Edits of the level: which voxels become solid or free.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "sim/block_set.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::sim {

/// The changes of an edit within one 4^3 block; a voxel is in at most one of the masks.
struct EditBlock {
  glm::i16vec3 at{0};            ///< voxel / 4
  std::uint64_t make_solid = 0;  ///< Bits as in VoxelBlock.
  std::uint64_t make_free = 0;
  bool operator==(const EditBlock&) const = default;
};

/// Blocks sorted by block_before, all distinct, none without a bit.
using EditBlocks = std::vector<EditBlock>;

/// Makes every voxel in [low, high) solid or free; clipped to the grid.
EditBlocks edit_box(const voxel::GridLayout& layout, glm::ivec3 low, glm::ivec3 high, bool solid);

/// The edits that turn `from` into `to` within [low, high) voxels; both of the same layout.
EditBlocks difference(const voxel::BitGrid& from, const voxel::BitGrid& to, glm::ivec3 low, glm::ivec3 high);

/// The combined effect of `earlier` followed by `later`.
EditBlocks merge_edits(std::span<const EditBlock> earlier, std::span<const EditBlock> later);

/// The part of the edits that changes the grid.
EditBlocks effective_edits(const voxel::BitGrid& grid, std::span<const EditBlock> edits);

/// The solid voxels of a block; none outside the grid.
std::uint64_t solid_bits(const voxel::BitGrid& grid, glm::ivec3 block);

/// Applies the edits to the grid; changes outside the grid are ignored.
void apply_edits(voxel::BitGrid& grid, std::span<const EditBlock> edits);

}  // namespace brume::sim
