// Edits of the level: which voxels become wall, glass, grille or free.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "sim/block_set.hpp"
#include "voxel/solids.hpp"

namespace brume::sim {

/// The changes of an edit within one 4^3 block; a voxel is in at most one of the masks.
struct EditBlock {
  glm::i16vec3 at{0};            ///< voxel / 4
  std::uint64_t make_solid = 0;  ///< A wall. Bits as in VoxelBlock.
  std::uint64_t make_free = 0;   ///< Nothing stays in it.
  std::uint64_t make_glass = 0, make_grille = 0;
  bool operator==(const EditBlock&) const = default;

  std::uint64_t all() const { return make_solid | make_free | make_glass | make_grille; }
  bool has_roles() const { return (make_glass | make_grille) != 0; }
  /// The same for the grid of what stops smoke alone: solid or free.
  EditBlock of_smoke() const { return {at, make_solid | make_glass, make_free | make_grille}; }
  EditBlock of_sight() const { return {at, make_solid, make_free | make_glass | make_grille}; }
  EditBlock of_bodies() const { return {at, make_solid | make_glass | make_grille, make_free}; }
};

/// Blocks sorted by block_before, all distinct, none without a bit.
using EditBlocks = std::vector<EditBlock>;

/// Makes every voxel in [low, high) solid or free; clipped to the grid.
EditBlocks edit_box(const voxel::GridLayout& layout, glm::ivec3 low, glm::ivec3 high, bool solid);

/// The edits that turn `from` into `to` within [low, high) voxels; both of the same layout.
EditBlocks difference(const voxel::Solids& from, const voxel::Solids& to, glm::ivec3 low, glm::ivec3 high);

/// The combined effect of `earlier` followed by `later`.
EditBlocks merge_edits(std::span<const EditBlock> earlier, std::span<const EditBlock> later);

EditBlock merge_edits(const EditBlock& earlier, const EditBlock& later);

/// Calls visit(a, b) in order for each block of two lists, with a block without bits for the one that a list
/// lacks.
template <typename Visit>
void for_each_pair(std::span<const EditBlock> a, std::span<const EditBlock> b, Visit visit);
/// The same for the blocks that are not alike in both. Null: a list without blocks.
template <typename Visit>
void for_each_difference(const EditBlocks* a, const EditBlocks* b, Visit visit);

/// The part of the edits that changes the level.
EditBlocks effective_edits(const voxel::Solids& level, std::span<const EditBlock> edits);

/// The edit that makes a block what it is in a level, whatever it was; without bits outside of the grid.
EditBlock content_of(const voxel::Solids& level, glm::ivec3 block);

/// The solid voxels of a block; none outside the grid.
std::uint64_t solid_bits(const voxel::BitGrid& grid, glm::ivec3 block);

/// Applies the edits to a grid of what stops smoke; changes outside the grid are ignored.
void apply_edits(voxel::BitGrid& grid, std::span<const EditBlock> edits);
/// The same for all grids of a level; adds grids of the roles that it had none of.
void apply_edits(voxel::BitGrid& grid, voxel::RoleGrids& roles, std::span<const EditBlock> edits);

template <typename Visit>
void for_each_pair(std::span<const EditBlock> a, std::span<const EditBlock> b, Visit visit) {
  auto i = a.begin();
  auto j = b.begin();
  while (i != a.end() || j != b.end()) {
    if (j == b.end() || (i != a.end() && block_before(i->at, j->at))) {
      visit(*i, EditBlock{.at = i->at});
      ++i;
    } else if (i == a.end() || block_before(j->at, i->at)) {
      visit(EditBlock{.at = j->at}, *j);
      ++j;
    } else {
      visit(*i++, *j++);
    }
  }
}

template <typename Visit>
void for_each_difference(const EditBlocks* a, const EditBlocks* b, Visit visit) {
  const auto blocks_of = [](const EditBlocks* list) {
    return list ? std::span<const EditBlock>(*list) : std::span<const EditBlock>();
  };
  for_each_pair(blocks_of(a), blocks_of(b), [&](const EditBlock& was, const EditBlock& is) {
    if (was != is) visit(was, is);
  });
}

}  // namespace brume::sim
