// The boundary cells of one brick: which voxels each corner takes its density from, past the surfaces in
// between. None of it changes from tick to tick.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "smoke/cell_sight.hpp"
#include "smoke/smoke_brick.hpp"
#include "volume/range_arena.hpp"
#include "volume/sparse_volume.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::smoke {

/// Where a boundary corner takes its density from: a voxel of the volume, slot * kVoxelsPerBrick +
/// local_voxel, or with this bit a mean of its brick.
constexpr std::uint32_t kMeanBit = 1u << 31;

/// A mean of voxels: the sum of weight * density, divided by total, rounded; voxels
/// that smoke never reaches count in the total only.
struct SmokeMean {
  std::uint32_t first;  ///< Where its voxels and weights begin.
  std::uint16_t count, total;
  std::uint16_t cell;  ///< The first cell, by local index, that has it: all it takes from is around that.
};
/// A corner set that smoke can reach.
struct CornerSource {
  std::array<std::uint32_t, 8> corners;
  std::uint32_t first_set;  ///< First corner set of its cell, in the brick.
  std::uint16_t cell;       ///< Local index of its cell.
  std::uint8_t sides;       ///< Bit q: the cell's set q has these corners.
};

/// The boundary cells of a brick, by rising local index.
struct BrickCells {
  std::vector<std::uint16_t> cells;           ///< Local index of each: x + 8 y + 64 z.
  std::vector<shared::BoundaryCell> records;  ///< first_set counted within the brick
  std::vector<SmokeMean> means;
  std::vector<std::uint32_t> mean_voxels;  ///< Voxels that the means take from, as at a corner,
  std::vector<std::uint8_t> mean_weights;  ///< and how much.
  std::vector<CornerSource> sources;
  /// How many means and sources each row of eight cells has, by y + 8 z; both are in the order of their
  /// cells.
  std::array<std::uint16_t, 64> means_of_row{}, sources_of_row{};
  std::uint32_t set_count = 0;

  std::vector<std::uint8_t> mean_values{0};  ///< The value of means[i] at i + 1; 0 at 0: no smoke.
  volume::IndexRange cell_range, set_range;  ///< In WallCells::boundary_cells and corner_sets.
};

/// Voxels -1 to 9 of a brick per axis: all that its cells take from. Row [z + 1][y + 1], bit x + 1.
using VoxelWindow = std::array<std::array<std::uint16_t, 11>, 11>;

/// The window of a brick from the bits of the 27 bricks around it, x + 3 y + 9 z of brick - at + 1; null: no
/// bit is set.
VoxelWindow make_window(const std::array<const BrickBits*, 27>& around);
/// The bits of the 27 bricks of a grid around one; null where there is none.
std::array<const BrickBits*, 27> solid_around(const voxel::BitGrid& grid, glm::ivec3 brick);

/// The cells of a brick with a solid corner: no others are boundary cells.
BrickBits cells_at_solid(const VoxelWindow& solid);

/// A brick and its surroundings.
struct BrickScene {
  glm::ivec3 brick{0};
  VoxelWindow solid, smoke;
  volume::NeighbourSlots slots;
};

/// Builds one brick after the other.
class CellBuilder {
 public:
  /// Whether a voxel of the grid is free and no smoke comes into its space.
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
