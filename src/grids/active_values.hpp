// The values of a grid's active voxels, one by one.
#pragma once

#include <bit>
#include <concepts>
#include <cstdint>

#include "grids/grid.hpp"

namespace brume::grids {

/// A cube of active voxels that have one value.
struct ActiveValue {
  const std::byte* value;  ///< Of the grid's type.
  glm::ivec3 low;          ///< Its voxel of the least coordinates.
  std::uint32_t edge;      ///< [voxels]: 1, or that of a tile.
  std::uint64_t count() const { return std::uint64_t{edge} * edge * edge; }
};

/// Calls use(active value) for the active voxels of bricks, then for active tiles, in the order of the grid. Where it
/// returns a bool, false ends the walk. True if nothing ended it.
template <typename Use>
bool for_each_active(const Grid& grid, const Use& use) {
  const auto goes_on = [&](const ActiveValue& value) {
    if constexpr (std::same_as<decltype(use(value)), bool>) {
      return use(value);
    } else {
      use(value);
      return true;
    }
  };
  const std::size_t bytes = bytes_of(grid.type);
  for (std::size_t i = 0; i < grid.bricks.size(); ++i) {
    const Brick& brick = grid.bricks[i];
    const std::byte* const values = grid.values_of(i).data();
    for (std::size_t z = 0; z < brick.active.size(); ++z)
      for (std::uint64_t word = brick.active[z]; word != 0; word &= word - 1) {
        const int in_layer = std::countr_zero(word);
        const std::size_t voxel = z * 64 + static_cast<std::size_t>(in_layer);
        const glm::ivec3 local(in_layer & 7, in_layer >> 3, static_cast<int>(z));
        if (!goes_on({values + voxel * bytes, brick.origin + local, 1})) return false;
      }
  }
  for (const Tile& tile : grid.tiles)
    if (tile.active && !goes_on({tile.value.data(), tile.origin, tile.edge})) return false;
  return true;
}

}  // namespace brume::grids
