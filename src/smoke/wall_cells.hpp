// The boundary cells of the smoke volume: where a surface runs through smoke, which densities its sides see
// (shared/smoke_volume.h, docs/how/smoke.md).
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "shared/smoke_volume.h"
#include "smoke/smoke_brick.hpp"
#include "smoke/smoke_structure.hpp"
#include "volume/range_arena.hpp"
#include "volume/sparse_volume.hpp"

namespace brume::smoke {

/// The cells that take from any of these voxels of a brick, in each of the 27 bricks around it, x + 3 y + 9
/// z.
std::array<BrickBits, 27> cells_that_take(const BrickBits& voxels);

/// Boundary cells are built brick by brick; their corner sets follow the densities. Slots are a volume's. All
/// changes happen between begin_update and end_update, and readers see them from end_update on.
class WallCells {
 public:
  /// `volume` must outlive it; what `planes` returns too, or until the brick is built again.
  WallCells(const volume::SparseVolume& volume, PlaneSource planes);
  WallCells(const WallCells&) = delete;
  WallCells& operator=(const WallCells&) = delete;

  void begin_update();
  /// The brick of a slot is new and has no boundary cell.
  void add(std::uint32_t slot);
  /// The brick of a slot goes, with its cells. To be called before the volume releases the slot.
  void remove(std::uint32_t slot);
  /// Builds the boundary cells of a brick, in place of those that it has.
  void build(std::uint32_t slot, const BrickScene& scene, const CellBuilder::Sealed& sealed);
  /// Densities of these voxels of a brick changed: the corner sets that take from them are stale.
  void densities_changed(glm::ivec3 brick, const BrickBits& voxels);
  /// Computes stale corner sets; `densities` by slot * kVoxelsPerBrick + local_voxel.
  void evaluate(std::span<const std::uint8_t> densities);
  /// Follows the volume's slot count after releases.
  void shrink();
  /// Publishes what is dirty.
  void end_update();

  /// kCellsPerBrick entries of a slot: boundary cell + 1, or 0.
  std::span<const std::uint32_t> cells(std::uint32_t slot) const;
  /// Some entries between the ones that cells name are unused.
  std::span<const shared::BoundaryCell> boundary_cells() const { return boundary_cells_; }
  std::span<const glm::uvec2> corner_sets() const { return corner_sets_; }

  /// Slots whose cells the last update changed or whose brick is new or gone, in rising order.
  std::span<const std::uint32_t> dirty_slots() const { return dirty_slots_; }
  /// What it changed of boundary_cells() and corner_sets(), in rising order and disjoint. Unchanged entries
  /// between close changes are included.
  std::span<const volume::IndexRange> dirty_boundary_cells() const { return dirty_boundary_cells_; }
  std::span<const volume::IndexRange> dirty_corner_sets() const { return dirty_corner_sets_; }

  /// Bytes of memory held.
  std::uint64_t bytes() const;

 private:
  using CellTable = std::array<std::uint32_t, shared::kCellsPerBrick>;
  struct Brick {
    std::unique_ptr<CellTable> cells;  // null: all 0
    std::unique_ptr<BrickCells> home;  // null: no boundary cell
    // What the update has done.
    bool touched = false, cells_changed = false, home_changed = false;
    volume::IndexRange sets_changed;  // part of home->set_range, counted in the brick
    BrickBits stale{};                // boundary cells whose corner sets are stale
  };

  void touch(std::uint32_t slot);
  void drop(std::uint32_t slot);
  void store(BrickCells& home);
  void write_cells(glm::ivec3 brick, const BrickCells& home, bool clear);
  void evaluate_means(BrickCells& home, const BrickBits& stale, std::span<const std::uint8_t> densities);
  volume::IndexRange evaluate_sets(BrickCells& home, const BrickBits& stale,
                                   std::span<const std::uint8_t> densities);
  template <typename Item>
  std::span<const std::uint32_t> stale_of(const std::vector<Item>& items,
                                          const std::array<std::uint16_t, 64>& items_of_row,
                                          const BrickBits& stale);

  const volume::SparseVolume& volume_;
  PlaneSource planes_;
  CellBuilder builder_;
  std::vector<Brick> bricks_;  // by slot
  volume::RangeArena cell_arena_, set_arena_;
  std::vector<shared::BoundaryCell> boundary_cells_;
  std::vector<glm::uvec2> corner_sets_;
  std::vector<std::uint32_t> touched_;  // slots with something to do or to report
  std::vector<std::uint32_t> stale_numbers_;
  std::vector<std::uint32_t> dirty_slots_;
  std::vector<volume::IndexRange> dirty_boundary_cells_, dirty_corner_sets_;
};

}  // namespace brume::smoke
