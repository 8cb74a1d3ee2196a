// The boundary cells of the smoke volume: where a surface runs through smoke, which densities its sides see
// (shared/smoke_volume.h, docs/how/smoke.md).
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <span>
#include <vector>

#include "shared/smoke_volume.h"
#include "smoke/cell_forms.hpp"
#include "smoke/growing_array.hpp"
#include "smoke/smoke_brick.hpp"
#include "smoke/voxel_window.hpp"
#include "volume/range_arena.hpp"
#include "volume/sparse_volume.hpp"

namespace brume::smoke {

/// Boundary cells are listed brick by brick (first_cell_of), and each is computed when it is first read after
/// a change. Slots are a volume's.
///
/// Threads: members that are not const are called by one thread at a time. Meanwhile others may call
/// `entries`, `computed`, `boundary_cell` and `corner_set` for bricks that are neither added, removed nor
/// built; the rest is for after `compute_all`.
class WallCells {
 public:
  /// What CellFormer calls for the cells of a brick.
  using SealedOfBrick = std::function<CellFormer::Sealed(glm::ivec3 brick)>;

  /// `volume` must outlive it; what `planes` returns too, or until the brick is built again.
  WallCells(const volume::SparseVolume& volume, PlaneSource planes);
  WallCells(const WallCells&) = delete;
  WallCells& operator=(const WallCells&) = delete;

  /// Nobody reads, from here until bricks have been added, removed and marked.
  void begin_update();
  /// The brick of a slot is new and has no boundary cell.
  void add(std::uint32_t slot);
  /// The brick of a slot goes, with its cells. To be called before the volume releases the slot.
  void remove(std::uint32_t slot);
  /// Follows the volume's slot count after releases.
  void shrink();

  /// Lists the boundary cells of a brick from what is solid and where smoke can be around it.
  /// `walls_changed`: planes or solid voxels did since the last time, not smoke alone.
  void build(std::uint32_t slot, const VoxelWindow& solid, const VoxelWindow& smoke, bool walls_changed);
  /// Densities of these voxels of a brick changed: the corner sets that take from them are stale.
  void densities_changed(glm::ivec3 brick, const BrickBits& voxels);
  /// Computes a cell; `densities` by slot * kVoxelsPerBrick + local_voxel.
  void compute(std::uint32_t slot, std::uint32_t cell, std::span<const std::uint8_t> densities,
               const CellFormer::Sealed& sealed);
  /// Computes all that is stale, and publishes what is dirty.
  void compute_all(std::span<const std::uint8_t> densities, const SealedOfBrick& sealed);

  /// For the 8^3 cells of a brick, by cell_in_brick: boundary cell + 1, or 0.
  const std::uint32_t* entries(std::uint32_t slot) const {
    return bricks_[slot].home ? bricks_[slot].home->entries.data() : kNoEntries.data();
  }
  /// Whether a boundary cell of a brick is computed: its planes and corner sets can be read.
  bool computed(std::uint32_t slot, std::uint32_t cell) const {
    std::uint64_t& stale = bricks_[slot].home->stale[cell >> 6];
    return (std::atomic_ref(stale).load(std::memory_order_acquire) >> (cell & 63) & 1) == 0;
  }
  const shared::BoundaryCell& boundary_cell(std::uint32_t number) const {
    return boundary_cells_.data()[number];
  }
  glm::uvec2 corner_set(std::uint32_t number) const { return corner_sets_.data()[number]; }

  /// kCellsPerBrick entries of a slot: boundary cell + 1, or 0.
  std::span<const std::uint32_t> cells(std::uint32_t slot) const;
  /// Some entries between the ones that cells name are unused.
  std::span<const shared::BoundaryCell> boundary_cells() const { return boundary_cells_.entries(); }
  std::span<const glm::uvec2> corner_sets() const { return corner_sets_.entries(); }
  /// Slots whose cells changed since begin_update or whose brick is new or gone, in rising order.
  std::span<const std::uint32_t> dirty_slots() const { return dirty_slots_; }
  /// What changed of boundary_cells() and corner_sets(), in rising order and disjoint. Unchanged entries
  /// between close changes are included.
  std::span<const volume::IndexRange> dirty_boundary_cells() const { return dirty_boundary_cells_; }
  std::span<const volume::IndexRange> dirty_corner_sets() const { return dirty_corner_sets_; }

  /// Bytes of memory held.
  std::uint64_t bytes() const;

 private:
  using CellTable = std::array<std::uint32_t, shared::kCellsPerBrick>;
  /// Part of an array that changed; empty: low >= high.
  struct Changes {
    std::uint32_t low = ~std::uint32_t{0}, high = 0;
    void add(const volume::IndexRange& range) {
      low = std::min(low, range.first);
      high = std::max(high, range.first + range.count);
    }
  };
  /// Corner sets of a brick's cells.
  struct SetChunk {
    volume::IndexRange range;
    std::uint32_t used = 0;
    Changes changed;  // since begin_update
  };
  /// A brick with boundary cells.
  struct Home {
    std::array<std::uint32_t, 512> entries{};
    std::array<std::uint32_t, 512> forms{};  // number + 1 of a cell's form; 0: not known
    BrickBits cells{}, stale{};              // boundary cells; those that have to be computed
    VoxelWindow solid{}, smoke{};
    volume::IndexRange cell_range;
    Changes cells_changed;         // since begin_update
    std::vector<SetChunk> chunks;  // corner sets of its cells, in the order in which they were computed
  };
  struct Brick {
    std::unique_ptr<CellTable> cells;  // null: all 0
    std::unique_ptr<Home> home;        // null: no boundary cell
    bool table_stale = false;          // `cells` has to be written
    bool changed_hands = false;        // since begin_update
    bool listed = false;               // in changed_
  };
  static constexpr std::array<std::uint32_t, 512> kNoEntries{};
  /// BoundaryCell::first_set of a cell that was never computed.
  static constexpr std::uint32_t kNoSets = ~std::uint32_t{0};

  void note(std::uint32_t slot);
  void drop(std::uint32_t slot);
  void mark_tables(glm::ivec3 brick);
  void list_cells(glm::ivec3 brick, const BrickBits& cells, Home& home);
  void give_back(Home& home);
  std::uint32_t take_sets(Home& home, std::uint32_t count);
  void write_sets(Home& home, std::uint32_t first, std::span<const glm::uvec2> sets);
  void compute(glm::ivec3 brick, Home& home, std::uint32_t cell, std::span<const std::uint8_t> densities,
               const CellFormer::Sealed& sealed);
  std::uint32_t form_of(glm::ivec3 brick, Home& home, std::uint32_t cell, const CellFormer::Sealed& sealed);
  CellDensities densities_around(glm::ivec3 cell, std::span<const std::uint8_t> densities) const;
  bool write_table(std::uint32_t slot);
  void publish();
  void move_former_to(glm::ivec3 brick);

  const volume::SparseVolume& volume_;
  PlaneSource planes_;
  CellFormer former_;
  bool former_placed_ = false;  // whether it is at former_brick_, with the planes of now
  glm::ivec3 former_brick_{0};
  CellForms forms_;
  std::vector<Brick> bricks_;  // by slot
  volume::RangeArena cell_arena_, set_arena_;
  GrowingArray<shared::BoundaryCell> boundary_cells_;
  GrowingArray<glm::uvec2> corner_sets_;
  std::uint64_t cell_count_ = 0;        // in all bricks
  std::vector<std::uint32_t> changed_;  // slots with something to report since begin_update
  std::vector<std::uint32_t> dirty_slots_;
  std::vector<volume::IndexRange> dirty_boundary_cells_, dirty_corner_sets_;
};

}  // namespace brume::smoke
