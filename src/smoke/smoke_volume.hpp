// The smoke of a state as renderer and line of sight read it (shared/smoke_volume.h): a sparse volume of
// densities and boundary cells at walls, updated tick by tick.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
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
#include "smoke/smoke_structure.hpp"
#include "smoke/wall_cells.hpp"
#include "volume/page_table.hpp"
#include "volume/range_arena.hpp"
#include "volume/sparse_volume.hpp"
#include "voxel/bit_grid.hpp"
#include "voxel/surface_planes.hpp"

namespace brume::smoke {

/// Writes the smoke of clouds, less what sinks take away, into a volume::SparseVolume (kDensityChannel) and
/// its WallCells. Bricks and boundary cells are built where a cloud comes or goes or the level changes, and
/// nowhere else; from tick to tick only densities change, and corner sets that take from them. After `update`
/// the content at each place depends on the state, the grid and the planes alone, not on what was there
/// before; slots and the numbers of boundary cells and corner sets do depend on it, and atlas_bricks never
/// shrinks.
class SmokeVolume final : public SmokeBricks {
 public:
  /// `grid` gives the layout. What `planes` returns must outlive the volume, or until planes_changed.
  SmokeVolume(const voxel::BitGrid& grid, PlaneSource planes);
  SmokeVolume(const SmokeVolume&) = delete;
  SmokeVolume& operator=(const SmokeVolume&) = delete;
  /// The same with the planes of the grid's own triangles, which must outlive the volume.
  SmokeVolume(const voxel::BitGrid& grid, const voxel::SurfacePlanes& planes);

  /// Takes over a state; `grid` is the level with the state's edits, of the constructor's layout. Differences
  /// to the last update are found from the state: clouds, sinks and edits that stayed cost almost nothing.
  /// Throws Error(resource_limit) when the smoke fills more bricks than a 3D texture holds; the volume is
  /// then of no further use.
  void update(const sim::State& state, const voxel::BitGrid& grid);
  void update(const sim::World& world) { update(world.state(), world.grid()); }
  /// The plane source returns other planes for cells within [low, high], both included. The next update
  /// rebuilds what depends on them.
  void planes_changed(glm::ivec3 low_cell, glm::ivec3 high_cell);

  /// The boundary cells.
  const WallCells& walls() const { return walls_; }
  /// Where the density of each cloud can be above 0, in no order; layout().bounds_min and max are around all.
  std::span<const Box<float>> cloud_bounds() const { return cloud_bounds_; }

  std::span<const std::uint32_t> cells(std::uint32_t slot) const override { return walls_.cells(slot); }
  std::span<const shared::BoundaryCell> boundary_cells() const override { return walls_.boundary_cells(); }
  std::span<const glm::uvec2> corner_sets() const override { return walls_.corner_sets(); }
  std::span<const std::uint32_t> dirty_cell_slots() const override { return walls_.dirty_slots(); }
  std::span<const volume::IndexRange> dirty_boundary_cells() const override {
    return walls_.dirty_boundary_cells();
  }
  std::span<const volume::IndexRange> dirty_corner_sets() const override {
    return walls_.dirty_corner_sets();
  }
  std::uint64_t structure_generation() const override { return generation_; }
  /// Bytes of memory held.
  std::uint64_t bytes() const;

 private:
  /// What a slot holds, and what the update has to do there.
  struct Brick {
    std::uint32_t cloud_count = 0;  // clouds that have a voxel within two of the brick
    std::vector<CloudPart> clouds;
    std::vector<SinkPart> sinks;  // by id
    BrickBits smoke{};            // voxels that a cloud has at some tick
    BrickBits cells_at_solid{};   // known once its cells are built
    bool touched = false;
    bool masks_stale = false, walls_stale = false, cells_stale = false, densities_stale = false;
  };

  // What came, went or changed in the state.
  void update_clouds(const sim::State& state);
  void update_sinks(const sim::State& state);
  void update_edits(const sim::State& state);
  void add_cloud(SmokeSource& source);
  void remove_cloud(const SmokeSource& source);
  void add_sink(const SmokeSink& sink);
  void remove_sink(const SmokeSink& sink);
  void voxels_changed(glm::ivec3 block, std::uint64_t mask);
  void mark_walls(glm::ivec3 low_voxel, glm::ivec3 high_voxel);
  void mark(std::uint32_t slot, bool Brick::*what);

  // Bricks and walls.
  std::uint32_t take_brick(glm::ivec3 brick);
  void release_brick(std::uint32_t slot);
  void release_unneeded();
  void update_structure();
  void update_mask(std::uint32_t slot);
  void build_cells(std::uint32_t slot);
  void update_bounds();

  void update_densities(std::uint32_t tick);

  voxel::GridLayout grid_layout_;
  const voxel::BitGrid* grid_ = nullptr;  // while updating
  SmokeSources sources_;
  std::shared_ptr<const sim::EditBlocks> edits_;  // in the last state
  std::vector<Box<float>> cloud_bounds_;

  volume::SparseVolume volume_;
  DensityChannel densities_;
  WallCells walls_;
  SealedPockets pockets_;
  std::vector<Brick> bricks_;  // by slot

  std::vector<std::uint32_t> touched_;  // slots that have something to do
  std::vector<glm::ivec3> stale_bricks_;
  std::vector<std::uint32_t> changed_slots_;
  std::vector<glm::ivec3> changed_bricks_;
  bool structure_changed_ = false;
  std::uint64_t generation_ = 0;
};

/// Density in [0, 1] at a point, exactly as the shaders read it.
float sample_density(const SmokeVolume& volume, glm::vec3 position_voxel);

}  // namespace brume::smoke
