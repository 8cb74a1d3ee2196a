// The voxels that the boundary cells of a brick take from, as rows of bits.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

#include "smoke/cell_sight.hpp"
#include "smoke/smoke_brick.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::smoke {

/// The lowest of the 8^3 cells of a brick: those that a ray passes in it, whose points lie in the brick moved
/// down by half a voxel.
inline glm::ivec3 first_cell_of(glm::ivec3 brick) {
  return 8 * brick - 1;
}
/// The brick of a cell, and its number there, x + 8 y + 64 z.
inline glm::ivec3 brick_of_cell(glm::ivec3 cell) {
  return (cell + 1) >> 3;
}
inline std::uint32_t cell_in_brick(glm::ivec3 cell) {
  return local_voxel(cell + 1);
}
inline glm::ivec3 cell_of_brick(glm::ivec3 brick, std::uint32_t number) {
  const auto n = static_cast<int>(number);
  return first_cell_of(brick) + glm::ivec3(n & 7, n >> 3 & 7, n >> 6);
}

/// Voxels -2 to 8 of a brick per axis: all that its cells take from. Row [z + 2][y + 2], bit x + 2.
using VoxelWindow = std::array<std::array<std::uint16_t, 11>, 11>;

/// The window of a brick from the bits of the 27 bricks around it, x + 3 y + 9 z of brick - at + 1; null: no
/// bit is set.
VoxelWindow make_window(const std::array<const BrickBits*, 27>& around);
/// The bits of the 27 bricks of a grid around one; null where there is none.
std::array<const BrickBits*, 27> solid_around(const voxel::BitGrid& grid, glm::ivec3 brick);

/// The 4x4x4 voxels around cell `number` of the brick.
Neighbourhood64 neighbourhood_of(const VoxelWindow& window, std::uint32_t number);
/// The cells of a brick with a solid corner: no others are boundary cells.
BrickBits cells_at_solid(const VoxelWindow& solid);
/// Those with smoke among the 4^3 voxels around them: no others are boundary cells.
BrickBits cells_near_smoke(const VoxelWindow& smoke);
/// The cells that take from any of these voxels of a brick, in each of the 27 bricks around it, x + 3 y + 9
/// z.
std::array<BrickBits, 27> cells_that_take(const BrickBits& voxels);

}  // namespace brume::smoke
