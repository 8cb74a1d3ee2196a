// The smoke that the device holds: the bricks of a SmokeVolume that a frame requires, in slots of their own.
// The device's memory follows what is in view, not the size of the world.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "planning/smoke_visibility.hpp"
#include "smoke/smoke_bricks.hpp"
#include "smoke/smoke_volume.hpp"

namespace brume::planning {

/// Bricks that are required no longer stay until their slots are. Where the bricks in view are more than
/// there is room for, all of them become coarser, by powers of two: smoke never disappears. A coarse voxel is
/// as dense as the densest one in it or beside it, so that it hides no less, and it knows no walls.
class ResidentSmoke final : public smoke::SmokeBricks {
 public:
  /// The coarsest: a brick covers a node of the page table's.
  static constexpr int kMostLevel = 3;
  static constexpr std::uint32_t kUnlimited = ~std::uint32_t{0};

  ResidentSmoke();

  struct Request {
    const smoke::SmokeVolume& volume;  ///< Updated for the frame.
    bool all = false;                  ///< Not only what is visible, but the whole volume.
    glm::vec3 eye_world{0};
    /// The device's atlas at present, which has room to begin with: 0, or what volume::grown_atlas returns.
    glm::ivec3 atlas_bricks{0};
    std::uint32_t most_bricks = kUnlimited;  ///< > 0; what such an atlas has room for, or kUnlimited.
  };
  /// Holds what is visible at the finest level at which what is in view takes no more than `most_bricks`; at
  /// kMostLevel the bricks nearest to the eye. Bricks that only dim light take what room is left, the nearest
  /// to the eye first. Returns the visibility in slots and voxels of this.
  SmokeVisibility update(const Request& request, const SmokeVisibility& visible, Allocator memory = {});

  /// Whether bricks of the last request are missing, or coarser than they should be.
  bool is_limited() const { return is_missing_ || level_ > 0; }
  /// Whether some are missing: as a rule those that only dim light.
  bool is_missing() const { return is_missing_; }
  /// How many bricks the last request wanted and has.
  std::uint32_t wanted_count() const { return wanted_count_; }
  /// Whether rays may meet smoke that was missing before, or miss some that was not.
  bool shows_other_smoke() const { return shows_other_; }

  std::span<const std::uint32_t> cells(std::uint32_t slot) const override;
  std::span<const shared::BoundaryCell> boundary_cells() const override;
  std::span<const glm::uvec2> corner_sets() const override;
  std::span<const std::uint32_t> dirty_cell_slots() const override { return dirty_cell_slots_; }
  std::span<const volume::IndexRange> dirty_boundary_cells() const override { return dirty_boundary_cells_; }
  std::span<const volume::IndexRange> dirty_corner_sets() const override { return dirty_corner_sets_; }
  std::uint64_t structure_generation() const override { return generation_; }
  int level() const override { return level_; }

 private:
  /// Bricks of a level: those in view, in order, then those that dim light, then others.
  struct Wanted {
    FrameVector<glm::ivec3> bricks;
    std::size_t visible = 0, required = 0;  // how many are in view, and with those that dim light
    bool is_limited = false;                // some have no room
  };
  FrameVector<glm::ivec3> choose_level(const Request& request, const SmokeVisibility& visible, int& level,
                                       Allocator memory) const;
  static Wanted wanted_at(int level, const Request& request, const SmokeVisibility& visible,
                          FrameVector<glm::ivec3> in_view);
  void restart(const smoke::SmokeVolume& source, int level, glm::ivec3 atlas);
  void find_changes(const smoke::SmokeVolume& source);
  bool has_changed(glm::ivec3 brick) const;
  void follow_changes();
  void make_room(std::size_t arriving, std::size_t wanted, std::size_t most, Allocator memory);
  void begin();
  void release(std::uint32_t slot);
  void write(std::uint32_t slot);
  void end();

  const smoke::SmokeVolume* source_ = nullptr;  // volume of the last update
  volume::SparseVolume held_;
  std::uint64_t source_id_ = 0, source_revision_ = 0, source_generation_ = 0;
  int level_ = 0;
  bool is_missing_ = false, shows_other_ = false;
  std::uint32_t wanted_count_ = 0;
  std::vector<std::uint64_t> last_frame_;  // by slot, the last frame that required it
  std::uint64_t frames_ = 0, generation_ = 0;

  // While it updates, and for readers after it.
  bool updating_ = false, everything_changed_ = false;
  std::vector<glm::ivec3> changed_bricks_;  // at the level, in order
  std::vector<std::uint32_t> dirty_cell_slots_;
  std::vector<volume::IndexRange> dirty_boundary_cells_, dirty_corner_sets_;
};

/// Sets the texels of a brick at a level above 0 from the volume's.
void fill_coarse_brick(const smoke::SmokeVolume& volume, int level, glm::ivec3 brick,
                       std::span<smoke::Texel, shared::kTexelsPerBrick> texels);

}  // namespace brume::planning
