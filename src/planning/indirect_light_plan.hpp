// Which indirect light a frame has (shaders/shared/indirect_light.h), and whether that of the frame before
// holds.
#pragma once

#include <cstddef>
#include <vector>

#include "core/box.hpp"
#include "planning/media_plan.hpp"

namespace brume::planning {

struct IndirectLightPlan {
  std::uint32_t bounces = 0;          ///< 0: there is none.
  std::vector<shared::Light> lights;  ///< All of the scene and of the frame, in view or not.
  Box<float> media = kEmptyBox;       ///< All smoke and the volumes of the frame [world space]; empty: none.
  bool level_changed = false;         ///< Walls or hidden objects, since the last plan with bounces.
  bool update = false;                ///< False: the light of the frame before holds.
};

/// Tracks what the device's indirect light was computed from.
class IndirectLightCache {
 public:
  /// The plan of a frame. It counts as done from then on.
  IndirectLightPlan plan(const FrameInput& input, const MediaPlan& media, std::vector<shared::Light> lights);

 private:
  LevelView level_;
  std::vector<std::uint32_t> hidden_objects_;
  bool has_level_ = false;
  std::vector<std::byte> key_;  ///< Of all other inputs of the last update; empty: none.
};

}  // namespace brume::planning
