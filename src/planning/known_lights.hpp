// The lights of a frame, by numbers that they keep from frame to frame, and which bricks each of them
// reaches.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "planning/smoke_visibility.hpp"
#include "shared/light.h"

namespace brume::planning {

/// Around the middle of a brick lie all its texels and points [voxels]: the corners of a cube of 11.
constexpr float kBrickReach = 9.53f;
/// The middle of a brick in the world.
glm::vec3 brick_middle(const shared::VolumeLayout& layout, glm::ivec3 brick);

/// A light keeps its number while its rays are the same: its intensity and range may change. Some lights that
/// are not lit are remembered, so that those that flicker keep theirs.
class KnownLights {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  struct Known {
    shared::Light light{};
    std::uint64_t version = 0;       ///< Unique: another one where `light` changed.
    std::uint64_t last_frame = 0;    ///< That had it.
    std::uint32_t in_frame = kNone;  ///< Its index among the lights of the frame; kNone: it is not lit.
  };

  /// Begins a frame. Numbers that other lights had before are in `renumbered`, until the next
  /// frame.
  void match(std::span<const shared::Light> lights);
  std::span<const std::uint32_t> renumbered() const { return renumbered_; }

  /// Finds which lights reach the visible bricks of the frame.
  void find_in_reach(const smoke::SmokeBricks& smoke, const SmokeVisibility& visibility, Allocator memory);
  /// The numbers of the lights that reach the brick SmokeVisibility::slots[visible_index], in the frame's
  /// order.
  std::span<const std::uint32_t> reaching(std::size_t visible_index) const;

  const Known& operator[](std::uint32_t number) const { return lights_[number]; }
  /// Another one where any of these lights changed.
  std::uint64_t versions_hash(std::span<const std::uint32_t> numbers) const;

 private:
  std::uint32_t number_for(const shared::Light& light, std::size_t hint, std::size_t most);

  std::vector<Known> lights_;
  std::vector<std::uint32_t> renumbered_;
  // The lights that reach each visible slot: their list, and where each slot's begin.
  std::vector<std::uint32_t> in_reach_, first_in_reach_;
  std::uint64_t frame_ = 0, versions_ = 0;
};

}  // namespace brume::planning
