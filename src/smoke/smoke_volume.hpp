// The smoke of a state as renderer and line of sight read it (shared/smoke_volume.h): a sparse volume of
// densities and boundary cells at walls, updated tick by tick.
#pragma once

#include <atomic>
#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

#include "core/box.hpp"
#include "shared/smoke_volume.h"
#include "sim/state.hpp"
#include "sim/world.hpp"
#include "smoke/density_channel.hpp"
#include "smoke/sealed_pockets.hpp"
#include "smoke/smoke_brick.hpp"
#include "smoke/smoke_bricks.hpp"
#include "smoke/smoke_sources.hpp"
#include "smoke/voxel_window.hpp"
#include "smoke/wall_cells.hpp"
#include "volume/page_table.hpp"
#include "volume/sparse_volume.hpp"
#include "voxel/bit_grid.hpp"
#include "voxel/surface_planes.hpp"

namespace brume::smoke {

/// Writes the smoke of clouds, less what sinks take away, into a volume::SparseVolume (kDensityChannel) and
/// its WallCells. After `update` the content at each place depends on the state, the grid and the planes
/// alone, not on what was there before; slots and the numbers of boundary cells and corner sets do depend on
/// it, and atlas_bricks never shrinks.
///
/// `update` takes and releases slots and notes what is stale; a brick's densities, and each of its boundary
/// cells, are computed when they are first read. Whoever reads `volume`, tables, lists of cells or what is
/// dirty has everything computed first. Any number of threads may call the const functions.
class SmokeVolume final : public SmokeBricks {
 public:
  /// `grid` gives the layout. What `planes` returns must outlive the volume, or until planes_changed.
  SmokeVolume(const voxel::BitGrid& grid, PlaneSource planes);
  SmokeVolume(const SmokeVolume&) = delete;
  SmokeVolume& operator=(const SmokeVolume&) = delete;
  /// The same with the planes of the grid's own triangles, which must outlive the volume.
  SmokeVolume(const voxel::BitGrid& grid, const voxel::SurfacePlanes& planes);

  /// Takes over a state; `grid` is the level with the state's edits, of the constructor's layout. It has to
  /// stay as it is while the volume is read. Differences to the last update are found from the state: clouds,
  /// sinks and edits that stayed cost almost nothing. Throws Error(resource_limit) when the smoke fills more
  /// bricks than a 3D texture holds; the volume is then of no further use.
  void update(const sim::State& state, const voxel::BitGrid& grid);
  void update(const sim::World& world) { update(world.state(), world.grid()); }
  /// The plane source returns other planes for cells within [low, high], both included. The next update,
  /// which has to come before anything is read, rebuilds what depends on them.
  void planes_changed(glm::ivec3 low_cell, glm::ivec3 high_cell);

  /// Where the density of each cloud can be above 0, in no order; layout().bounds_min and max are around all.
  std::span<const Box<float>> cloud_bounds() const { return cloud_bounds_; }

  // One brick or cell at a time.
  std::span<const Texel> texels(std::uint32_t slot) const override {
    prepare(slot);
    return volume_.texels<Texel>(kDensityChannel, slot);
  }
  /// For the 8^3 cells of a brick, by cell_in_brick: boundary cell + 1, or 0.
  const std::uint32_t* entries(std::uint32_t slot) const {
    prepare(slot);
    return walls_.entries(slot);
  }
  /// The boundary cell that entry `cell` of a brick names. Valid until the next update.
  const shared::BoundaryCell& boundary_cell(std::uint32_t slot, std::uint32_t cell,
                                            std::uint32_t entry) const {
    if (!walls_.computed(slot, cell)) compute_cell(slot, cell);
    return walls_.boundary_cell(entry - 1);
  }
  /// A corner set of a boundary cell that was returned before.
  glm::uvec2 corner_set(std::uint32_t number) const { return walls_.corner_set(number); }

  // All of it.
  const volume::SparseVolume& volume() const override { return complete(), volume_; }
  std::span<const std::uint32_t> cells(std::uint32_t slot) const override {
    return complete(), walls_.cells(slot);
  }
  std::span<const shared::BoundaryCell> boundary_cells() const override {
    return complete(), walls_.boundary_cells();
  }
  std::span<const glm::uvec2> corner_sets() const override { return complete(), walls_.corner_sets(); }
  std::span<const std::uint32_t> dirty_cell_slots() const override {
    return complete(), walls_.dirty_slots();
  }
  std::span<const volume::IndexRange> dirty_boundary_cells() const override {
    return complete(), walls_.dirty_boundary_cells();
  }
  std::span<const volume::IndexRange> dirty_corner_sets() const override {
    return complete(), walls_.dirty_corner_sets();
  }
  std::uint64_t structure_generation() const override { return generation_; }
  /// Slots that the last update took or released, in rising order.
  std::span<const std::uint32_t> dirty_bricks() const { return volume_.dirty_bricks(); }
  /// Bytes of memory held.
  std::uint64_t bytes() const;

 private:
  /// What a slot holds, and what is stale there.
  struct Brick {
    std::uint32_t cloud_count = 0;  // clouds that have a voxel within two of the brick
    std::vector<CloudPart> clouds;
    std::vector<SinkPart> sinks;  // by id
    BrickBits smoke{};            // voxels that a cloud has at some tick
    BrickBits cells_at_solid{};   // known once walls_stale is false
    bool touched = false;         // in touched_
    bool masks_stale = false;     // within an update only
    bool walls_stale = false, cells_stale = false, densities_stale = false;
  };

  // What came, went or changed in the state.
  void update_clouds(const sim::State& state);
  void update_sinks(const sim::State& state);
  void update_edits(const sim::State& state);
  void update_densities(std::uint32_t tick);
  void add_cloud(SmokeSource& source);
  void remove_cloud(const SmokeSource& source);
  void add_sink(const SmokeSink& sink);
  void remove_sink(const SmokeSink& sink);
  void voxels_changed(glm::ivec3 block, std::uint64_t mask);
  void mark_walls(glm::ivec3 low_voxel, glm::ivec3 high_voxel);
  void mark_masks(std::uint32_t slot);
  void mark_cells(std::uint32_t slot, bool walls);
  void mark_densities(glm::ivec3 brick);

  // Bricks.
  std::uint32_t take_brick(glm::ivec3 brick);
  void release_brick(std::uint32_t slot);
  void release_unneeded();
  void update_structure();
  void update_mask(std::uint32_t slot);
  void update_bounds();

  // What is computed when it is read.
  void prepare(std::uint32_t slot) const {
    if (!is_ready(slot)) prepare_now(slot);
  }
  bool is_ready(std::uint32_t slot) const {
    return std::atomic_ref(ready_[slot]).load(std::memory_order_acquire) != 0;
  }
  void complete() const {
    if (!complete_.load(std::memory_order_acquire)) complete_now();
  }
  void prepare_now(std::uint32_t slot) const;
  void complete_now() const;
  void compute_cell(std::uint32_t slot, std::uint32_t cell) const;
  // With mutex_ locked.
  void prepare_locked(std::uint32_t slot) const;
  void build_cells(std::uint32_t slot, const volume::NeighbourSlots& around) const;
  CellFormer::Sealed sealed_for(glm::ivec3 brick) const;

  voxel::GridLayout grid_layout_;
  const voxel::BitGrid* grid_ = nullptr;  // the last update's
  SmokeSources sources_;
  std::shared_ptr<const sim::EditBlocks> edits_;  // in the last state
  std::vector<Box<float>> cloud_bounds_;
  std::vector<std::uint32_t> touched_;  // slots whose masks or clouds changed
  std::vector<glm::ivec3> stale_bricks_;
  std::vector<const SmokeSource*> moved_clouds_;
  std::vector<std::uint32_t> changed_slots_;
  std::vector<glm::ivec3> changed_bricks_;
  bool structure_changed_ = false;
  std::uint64_t generation_ = 0;

  // Written by whoever reads first.
  mutable std::mutex mutex_;
  mutable volume::SparseVolume volume_;
  mutable DensityChannel densities_;
  mutable WallCells walls_;
  mutable SealedPockets pockets_;
  mutable std::vector<Brick> bricks_;        // by slot
  mutable std::vector<std::uint8_t> ready_;  // by slot: whether all but boundary cells is computed
  mutable std::atomic<bool> complete_{true};
};

/// Density in [0, 1] at a point, exactly as the shaders read it.
float sample_density(const SmokeVolume& volume, glm::vec3 position_voxel);

}  // namespace brume::smoke
