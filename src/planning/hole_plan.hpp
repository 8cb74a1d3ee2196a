// Which holes a frame cuts out of the smoke, and how much room their clusters take (shared/hole_clusters.h).
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "core/frame_memory.hpp"
#include "shared/hole_clusters.h"
#include "shared/hole_reach.h"
#include "shared/smoke_volume.h"

namespace brume::planning {

/// Where more pairs of a brick and a hole meet, or more bricks have holes than chunk_capacity may be (7,000),
/// light does not read some holes.
constexpr std::uint32_t kMaxHolePairs = 1u << 22;

/// All that is known of a frame's holes before the device has clustered them.
struct HolePlan {
  FrameVector<shared::Hole> holes;         ///< Holes that may remove smoke: the last kMaxHoles.
  FrameVector<shared::HoleReach> reaches;  ///< Reach of each hole, inside the smoke's bounds.
  float time = 0;                          ///< [s]
  std::uint32_t slot_count = 0;            ///< Slots of the volume's bricks.
  /// Never less than the pairs of a brick and a hole that meet, up to kMaxHolePairs.
  std::uint32_t pair_capacity = 0;
  std::uint32_t chunk_capacity = 0;  ///< Bricks with holes that have cells.
  glm::uvec2 coarse_tiles{0};        ///< How many cover the frame.
  std::uint32_t cluster_count = 0;   ///< Entries of the lists before their words.
  std::uint32_t word_capacity = 0;   ///< Words that the lists may take.

  /// As the frame's constants describe the clusters to shaders.
  shared::HoleClusterLayout layout() const;
};

/// Plans the holes that are open at `time` in smoke of `slot_count` bricks, for a frame of `size_px`; without
/// smoke none is. Noise moves their rims by up to `rim` metres.
HolePlan plan_holes(std::span<const shared::Hole> holes, float time, float rim,
                    const shared::VolumeLayout& volume, std::uint32_t slot_count, glm::uvec2 size_px,
                    Allocator memory = {});

/// Packs holes for the device (shared::PackedHole) as they are at `time`.
FrameVector<shared::PackedHole> pack_holes(std::span<const shared::Hole> holes, float time,
                                           Allocator memory = {});
FrameVector<shared::PackedReach> pack_reaches(std::span<const shared::HoleReach> reaches,
                                              Allocator memory = {});

}  // namespace brume::planning
