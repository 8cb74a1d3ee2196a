// Smoke as bricks (shared/smoke_volume.h): what planning, passes and uploads read of it, whoever holds it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>

#include "shared/smoke_volume.h"
#include "smoke/density_channel.hpp"
#include "smoke/smoke_brick.hpp"
#include "volume/range_arena.hpp"
#include "volume/sparse_volume.hpp"

namespace brume::smoke {

/// A sparse volume of densities, and the boundary cells of its slots. What is dirty is all that differs from
/// revision() - 1.
class SmokeBricks {
 public:
  static constexpr std::uint32_t kNoSlot = volume::SparseVolume::kNoSlot;

  virtual ~SmokeBricks() = default;
  SmokeBricks(const SmokeBricks&) = delete;
  SmokeBricks& operator=(const SmokeBricks&) = delete;

  /// The bricks: page table, slots, density channel.
  virtual const volume::SparseVolume& volume() const { return bricks_; }
  virtual std::span<const Texel> texels(std::uint32_t slot) const {
    return bricks_.texels<Texel>(kDensityChannel, slot);
  }

  // Boundary cells.
  /// kCellsPerBrick entries of a slot: boundary cell + 1, or 0.
  virtual std::span<const std::uint32_t> cells(std::uint32_t slot) const = 0;
  virtual std::span<const shared::BoundaryCell> boundary_cells() const = 0;
  virtual std::span<const glm::uvec2> corner_sets() const = 0;
  virtual std::span<const std::uint32_t> dirty_cell_slots() const = 0;
  virtual std::span<const volume::IndexRange> dirty_boundary_cells() const = 0;
  virtual std::span<const volume::IndexRange> dirty_corner_sets() const = 0;
  /// The number of updates in which a cloud came or went, or pages, cells or boundary cells changed.
  virtual std::uint64_t structure_generation() const = 0;
  /// A voxel is 2^level voxels of the simulation wide.
  virtual int level() const { return 0; }

  /// Whether the last update changed a corner set.
  bool corner_sets_dirty() const { return !dirty_corner_sets().empty(); }
  std::span<const std::uint32_t> dirty_slots() const { return volume().dirty(kDensityChannel); }

  // Functions of the sparse volume that read no texel.
  std::uint64_t id() const { return bricks_.id(); }
  const shared::VolumeLayout& layout() const { return bricks_.layout(); }
  const volume::PageTable& pages() const { return bricks_.pages(); }
  std::uint32_t slot_count() const { return bricks_.slot_count(); }
  std::uint32_t slot_at(glm::ivec3 brick) const { return bricks_.slot_at(brick); }
  bool in_use(std::uint32_t slot) const { return bricks_.in_use(slot); }
  glm::ivec3 brick_of(std::uint32_t slot) const { return bricks_.brick_of(slot); }
  std::uint64_t revision() const { return bricks_.revision(); }

 protected:
  /// `bricks`, which may not exist yet, lives as long as this.
  explicit SmokeBricks(const volume::SparseVolume& bricks) : bricks_(bricks) {}

 private:
  const volume::SparseVolume& bricks_;
};

}  // namespace brume::smoke
