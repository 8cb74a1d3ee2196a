// The smoke of a world as the renderer reads it (shared/smoke_volume.h), kept up to date tick by tick.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "shared/smoke_volume.h"
#include "sim/smoke_structure.hpp"
#include "sim/world.hpp"
#include "voxel/bit_grid.hpp"
#include "voxel/surface_planes.hpp"

namespace brume::sim {

/// One texel of the density texture.
struct Texel {
  std::uint8_t density = 0;  ///< R
  std::uint8_t free = 0;     ///< G: 255 in a free voxel, 0 in a solid one.
  bool operator==(const Texel&) const = default;
};

/// Where the smoke is (window, slots, cells, planes) is made anew when a cloud comes or goes; from tick to
/// tick only texel densities and corner sets change. After `update` the content depends on the world's state
/// alone, not on the ticks before it; only atlas_bricks never shrinks.
class SmokeVolume {
 public:
  /// `grid` and what `planes` returns must outlive the volume.
  SmokeVolume(const voxel::BitGrid& grid, PlaneSource planes);
  /// The same with the planes of the grid's own triangles, which must outlive the volume.
  SmokeVolume(const voxel::BitGrid& grid, const voxel::SurfacePlanes& planes);

  /// Takes over the clouds of the world at its tick. The world must stand on the same grid.
  void update(const World& world);

  const shared::SmokeVolumeFrame& frame() const { return frame_; }
  /// Slot + 1 or 0 for each brick of the window; empty when there is no smoke.
  std::span<const std::uint32_t> page_table() const { return structure_.page_table; }
  std::uint32_t slot_count() const { return static_cast<std::uint32_t>(structure_.bricks.size()); }
  /// What slot_at returns where there is no smoke.
  static constexpr std::uint32_t kNoSlot = ~std::uint32_t{0};
  /// The slot of a brick (voxel / 8, rounded down), or kNoSlot.
  std::uint32_t slot_at(glm::ivec3 brick) const;
  /// kTexelsPerBrick texels, x + 10 (y + 10 z).
  std::span<const Texel> texels(std::uint32_t slot) const;
  /// kCellsPerBrick entries: boundary cell + 1, or 0.
  std::span<const std::uint32_t> cells(std::uint32_t slot) const;
  std::span<const shared::BoundaryCell> boundary_cells() const { return structure_.boundary_cells; }
  std::span<const glm::uvec2> corner_sets() const { return corner_sets_; }

  /// Rises whenever window, slots, cells or boundary cells changed.
  std::uint64_t structure_generation() const { return generation_; }
  /// Rises with each update: what is dirty is dirty since the revision before.
  std::uint64_t revision() const { return revision_; }
  /// Slots whose texels the last update changed, in rising order; all after a change of structure.
  std::span<const std::uint32_t> dirty_slots() const { return dirty_slots_; }
  /// Whether the last update changed a corner set.
  bool corner_sets_dirty() const { return corner_sets_dirty_; }

 private:
  void rebuild(std::span<const LiveCloud> clouds);
  void refresh(std::vector<std::uint8_t> densities, bool all);
  glm::uvec2 evaluate_set(std::size_t set) const;

  const voxel::BitGrid& grid_;
  PlaneSource planes_;
  shared::SmokeVolumeFrame frame_{};
  SmokeStructure structure_;
  std::vector<std::uint64_t> cloud_hashes_;
  std::vector<std::uint8_t> densities_;  // of each voxel of the structure
  std::vector<Texel> texels_;
  std::vector<glm::uvec2> corner_sets_;
  std::vector<std::uint32_t> dirty_slots_;
  bool corner_sets_dirty_ = false;
  std::uint64_t generation_ = 0;
  std::uint64_t revision_ = 0;
};

/// Density in [0, 1] at a point, exactly as the shaders read it.
float sample_density(const SmokeVolume& volume, glm::vec3 position_voxel);

}  // namespace brume::sim
