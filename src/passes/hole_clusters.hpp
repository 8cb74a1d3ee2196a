// Culling of holes (shared/hole_clusters.h), repeated each frame because holes open and close.
#pragma once

#include <span>
#include <vector>

#include "passes/hole_masks.hpp"
#include "passes/smoke_upload.hpp"
#include "shared/frame.h"
#include "shared/hole_reach.h"

namespace brume::passes {

/// Holes of a frame, and upper limits for the culling on the device.
struct HolePlan {
  std::vector<shared::Hole> holes;         ///< Those that may remove smoke; at most kMaxHoles, the last ones.
  std::vector<shared::HoleReach> reaches;  ///< One per hole, clipped to the smoke's bounds.
  std::uint32_t pair_capacity = 0;  ///< At least the (brick, hole) pairs that meet, up to kMaxHolePairs.
  std::uint32_t block_capacity = 0;
};

/// With more pairs, or with more bricks that have holes than the limit of block_capacity (7,000), light
/// ignores some holes.
constexpr std::uint32_t kMaxHolePairs = 1u << 22;

/// Plans the holes that are open at `time` in smoke of `slot_count` bricks; noise moves their rims by up to
/// `rim` metres.
HolePlan plan_holes(std::span<const shared::Hole> holes, float time, float rim,
                    const shared::VolumeLayout& volume, std::uint32_t slot_count);

/// Packs holes for the device as they are at `time`.
std::vector<shared::PackedHole> pack_holes(std::span<const shared::Hole> holes, float time);

/// Holes on the device, for every pass that evaluates them.
struct HoleResources {
  gpu::Buffer holes;    ///< shared::PackedHole.
  gpu::Buffer reaches;  ///< shared::PackedReach, one per hole.
  gpu::Buffer lists, cells;
  gpu::Image masks;  ///< The mask atlas.
  bool any = false;  ///< Whether any hole is open in this frame.
};

class HoleClusters {
 public:
  /// Uploads the masks.
  HoleClusters(gpu::Context& context, gpu::CommandRunner& runner, const smoke::MaskAtlas& masks);
  /// Other masks instead. When the device is done with what was recorded before.
  void set_masks(gpu::Context& context, gpu::CommandRunner& runner, const smoke::MaskAtlas& masks);

  /// Plans the frame and makes room. Not between the begin and the end of a recording, and only when the
  /// device is done with what it recorded before. Throws resource_limit.
  void reserve(std::span<const shared::Hole> holes, float time, float rim, const shared::VolumeLayout& volume,
               std::uint32_t slot_count, glm::uvec2 size_px);
  /// What the frame's constants must say.
  shared::HoleClusterLayout layout() const;
  /// Uploads the holes and finds where they are, after the frame's constants and the smoke were uploaded.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SmokeResources& smoke);

  const HoleResources& resources() const { return resources_; }

 private:
  gpu::Context& context_;
  gpu::ComputePipeline tiles_pass_, groups_pass_, bricks_pass_, cells_pass_;
  gpu::Sampler nearest_;
  HoleResources resources_;
  gpu::Buffer coarse_tile_holes_, pairs_, counters_, words_taken_;
  HolePlan plan_;
  float time_ = 0;
  std::uint32_t slot_count_ = 0;
  glm::uvec2 tiles_{0};
  std::uint32_t entries_at_ = 0, entry_capacity_ = 0;
};

}  // namespace brume::passes
