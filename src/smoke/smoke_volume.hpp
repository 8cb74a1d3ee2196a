// The smoke of a state as renderer and line of sight read it (shared/smoke_volume.h), kept up to date tick by
// tick.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <queue>
#include <span>
#include <vector>

#include "shared/smoke_volume.h"
#include "volume/page_table.hpp"
#include "volume/range_arena.hpp"
#include "smoke/smoke_brick.hpp"
#include "smoke/smoke_structure.hpp"
#include "sim/state.hpp"
#include "sim/world.hpp"
#include "voxel/bit_grid.hpp"
#include "voxel/surface_planes.hpp"

namespace brume::smoke {

/// A box of points [voxel space].
struct SmokeBounds {
  glm::vec3 low{0}, high{0};
};

/// Bricks and boundary cells are built where a cloud comes or goes or the level changes, and nowhere else;
/// from tick to tick densities change, and corner sets that take from them. After `update` the content at
/// each place depends on the state, the grid and the planes alone, not on what was there before; slots and
/// the numbers of boundary cells and corner sets do depend on it, and atlas_bricks never shrinks.
class SmokeVolume {
 public:
  /// `grid` gives the layout. What `planes` returns must outlive the volume, or until planes_changed.
  SmokeVolume(const voxel::BitGrid& grid, PlaneSource planes);
  SmokeVolume(const SmokeVolume&) = delete;
  SmokeVolume& operator=(const SmokeVolume&) = delete;
  /// The same with the planes of the grid's own triangles, which must outlive the volume.
  SmokeVolume(const voxel::BitGrid& grid, const voxel::SurfacePlanes& planes);

  /// Takes over a state; `grid` is the level with the state's edits, of the constructor's layout. What differs
  /// from the last update is found from the state: clouds, blasts and edits that stayed cost next to nothing.
  /// Throws Error(resource_limit) when the smoke fills more bricks than a 3D texture holds; the volume is
  /// then of no further use.
  void update(const sim::State& state, const voxel::BitGrid& grid);
  void update(const sim::World& world) { update(world.state(), world.grid()); }
  /// Says that the plane source answers otherwise for cells within [low, high], both included. The next
  /// update builds anew what depends on them.
  void planes_changed(glm::ivec3 low_cell, glm::ivec3 high_cell);

  const shared::VolumeLayout& layout() const { return layout_; }
  /// Where the density of each cloud can be above 0, in no order; layout().bounds_min and max are around all.
  std::span<const SmokeBounds> cloud_bounds() const { return cloud_bounds_; }
  const volume::PageTable& pages() const { return pages_; }
  /// Slots are 0 to slot_count() - 1; some may be out of use, all 0. None: no smoke.
  std::uint32_t slot_count() const { return static_cast<std::uint32_t>(slots_.size()); }
  /// What slot_at returns where there is no smoke.
  static constexpr std::uint32_t kNoSlot = volume::PageTable::kNoSlot;
  /// The slot of a brick (voxel / 8, rounded down), or kNoSlot.
  std::uint32_t slot_at(glm::ivec3 brick) const { return pages_.at(brick); }
  /// The brick of a slot; of one out of use, any.
  glm::ivec3 brick_of(std::uint32_t slot) const { return slots_[slot]->at; }
  /// kTexelsPerBrick texels, x + 10 (y + 10 z).
  std::span<const Texel> texels(std::uint32_t slot) const { return slots_[slot]->texels; }
  /// kCellsPerBrick entries: boundary cell + 1, or 0.
  std::span<const std::uint32_t> cells(std::uint32_t slot) const;
  /// Some out of use between those that the cells name.
  std::span<const shared::BoundaryCell> boundary_cells() const { return boundary_cells_; }
  std::span<const glm::uvec2> corner_sets() const { return corner_sets_; }

  /// Rises whenever pages, cells or boundary cells changed.
  std::uint64_t structure_generation() const { return generation_; }
  /// Rises with each update: what is dirty is dirty since the revision before.
  std::uint64_t revision() const { return revision_; }
  /// Slots whose texels the last update changed or that are new, in rising order.
  std::span<const std::uint32_t> dirty_slots() const { return dirty_slots_; }
  /// Slots whose cells it changed or that are new, in rising order.
  std::span<const std::uint32_t> dirty_cell_slots() const { return dirty_cell_slots_; }
  /// What it changed of boundary_cells() and corner_sets(), in rising order, apart from each other; what lies
  /// between may be named too.
  std::span<const volume::IndexRange> dirty_boundary_cells() const { return dirty_boundary_cells_; }
  std::span<const volume::IndexRange> dirty_corner_sets() const { return dirty_corner_sets_; }
  /// Whether the last update changed a corner set.
  bool corner_sets_dirty() const { return !dirty_corner_sets_.empty(); }

  /// Bytes of memory held.
  std::uint64_t bytes() const;

 private:
  // Where the smoke is (smoke_volume.cpp).
  void take_clouds(const sim::State& state);
  void take_blasts(const sim::State& state);
  void take_edits(const sim::State& state);
  void add_cloud(SmokeSource& source);
  void remove_cloud(SmokeSource& source);
  void add_blast(SmokeSink& sink);
  void remove_blast(const SmokeSink& sink);
  std::uint32_t need_brick(glm::ivec3 brick);
  void free_slot(std::uint32_t slot);
  void voxels_changed(glm::ivec3 block, std::uint64_t mask);
  void mark_walls(glm::ivec3 low_voxel, glm::ivec3 high_voxel);
  void mark(std::uint32_t slot, bool SmokeBrick::*what);
  std::array<std::uint32_t, 27> slots_around(glm::ivec3 brick) const;

  // How its walls are seen (smoke_walls.cpp).
  void update_structure();
  void update_mask(std::uint32_t slot);
  void fill_free(SmokeBrick& brick, const VoxelWindow& solid);
  void build_cells(SmokeBrick& brick);
  void drop_cells(SmokeBrick& brick);
  void write_cells(const SmokeBrick& brick, bool clear);
  void free_unneeded();
  void update_layout();

  // How dense it is (smoke_refresh.cpp).
  void update_phases(const sim::State& state);
  void update_phase(SmokeSource& source, std::uint32_t tick);
  void refresh_densities(std::uint32_t slot);
  void spread_changes(SmokeBrick& brick);
  void fill_texels(SmokeBrick& brick);
  template <typename Thing>
  std::span<const std::uint32_t> stale_of(const std::vector<Thing>& things, const BrickBits& stale);
  void evaluate_cells(SmokeBrick& brick);
  void refresh();
  void report_changes();

  voxel::GridLayout grid_layout_;
  PlaneSource planes_;
  CellBuilder builder_;
  SealedPockets pockets_;
  const voxel::BitGrid* grid_ = nullptr;  // while updating

  std::vector<std::unique_ptr<SmokeSource>> sources_;  // by id
  std::vector<std::unique_ptr<SmokeSink>> sinks_;      // by id
  // In one piece what each tick asks of all sources: what the state had, and whether anything can be new.
  std::vector<sim::LiveCloud> seen_clouds_;
  std::vector<TickSpan> steady_;
  std::shared_ptr<const sim::EditBlocks> edits_;

  shared::VolumeLayout layout_{};
  std::vector<SmokeBounds> cloud_bounds_;
  volume::PageTable pages_;
  std::vector<std::unique_ptr<SmokeBrick>> slots_;
  std::priority_queue<std::uint32_t, std::vector<std::uint32_t>, std::greater<>> free_slots_;
  std::vector<std::uint8_t> densities_;  // kVoxelsPerBrick a slot
  volume::RangeArena cell_arena_, set_arena_;
  std::vector<shared::BoundaryCell> boundary_cells_;
  std::vector<glm::uvec2> corner_sets_;

  // Of the update going on, or the last one.
  std::vector<std::uint32_t> touched_;  // slots that have something to do
  std::vector<glm::ivec3> stale_bricks_;
  bool structure_changed_ = false;
  std::vector<std::uint8_t> scratch_;
  std::vector<std::uint32_t> stale_numbers_;
  std::vector<std::uint32_t> dirty_slots_, dirty_cell_slots_;
  std::vector<volume::IndexRange> dirty_boundary_cells_, dirty_corner_sets_;
  std::uint64_t generation_ = 0;
  std::uint64_t revision_ = 0;
};

/// Density in [0, 1] at a point, exactly as the shaders read it.
float sample_density(const SmokeVolume& volume, glm::vec3 position_voxel);

}  // namespace brume::smoke
