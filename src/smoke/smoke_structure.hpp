// The boundary cells of one brick: which voxels each corner takes its density from, past the surfaces in
// between. All that stays the same from tick to tick.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>

#include "smoke/cell_block.hpp"
#include "smoke/sealed_pockets.hpp"
#include "smoke/smoke_brick.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::smoke {

/// Voxels -1 to 9 of a brick per axis: all that its cells take from. Row [z + 1][y + 1], bit x + 1.
using VoxelWindow = std::array<std::array<std::uint16_t, 11>, 11>;

/// The window of a brick from the bits of the 27 bricks around it, x + 3 y + 9 z of brick - at + 1; null: no
/// bit is set.
VoxelWindow window_of(const std::array<const BrickBits*, 27>& around);
/// The bits of the 27 bricks of a grid around one; null where there is none.
std::array<const BrickBits*, 27> solid_around(const voxel::BitGrid& grid, glm::ivec3 brick);

/// A brick and its surroundings.
struct BrickScene {
  glm::ivec3 brick{0};
  VoxelWindow solid, smoke;
  std::array<std::uint32_t, 27> slots;  ///< Of the bricks around, as window_of counts them.
};

/// Builds one brick after the other.
class CellBuilder {
 public:
  /// Says of a voxel of the grid whether it is free and no smoke comes into its space.
  using Sealed = std::function<bool(glm::ivec3 voxel)>;

  explicit CellBuilder(const PlaneSource& planes);
  ~CellBuilder();

  /// The boundary cells of a brick; null when there is none. first_set is counted from 0.
  std::unique_ptr<BrickCells> build(const BrickScene& scene, const Sealed& sealed);

 private:
  class Work;
  std::unique_ptr<Work> work_;
};

}  // namespace brume::smoke
