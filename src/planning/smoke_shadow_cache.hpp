// Which rays of the smoke shadows (shared/smoke_shadow.h) a frame marches, and which still hold.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "planning/hole_plan.hpp"
#include "planning/input_key.hpp"
#include "planning/noise_plan.hpp"
#include "planning/proposed.hpp"
#include "planning/smoke_shadow_plan.hpp"
#include "planning/update_scheduler.hpp"

namespace brume::planning {

/// What the smoke shadows of a frame follow from: all that shaders/smoke_shadow.comp reads. It reads no
/// camera; that counts only as far as it changes the plan, or which smoke casts visible shadows.
struct SmokeShadowInputs {
  const smoke::SmokeBricks* volume = nullptr;   ///< Null: no smoke.
  const SmokeVisibility* visibility = nullptr;  ///< Not null.
  std::span<const shared::Light> lights;        ///< FramePlan::lights.
  const HolePlan* holes = nullptr;              ///< Not null.
  const NoisePlan* noise = nullptr;             ///< Not null.
  shared::SmokeLook look{};
  float time = 0;             ///< Time of the noise [s].
  bool rebuild = false;       ///< Surfaces changed, or shadows are to be marched again for another reason.
  float update_fraction = 1;  ///< Quality::light_update_fraction.
};

/// The texels that a frame marches: of each rectangle every `spread`th along both axes, from `first` on.
struct SmokeShadowUpdate {
  SmokeShadowPlan plan;  ///< With blocks of these texels.
  std::uint32_t spread = 1;
  glm::uvec2 first{0};
};

/// Tracks what the device's atlas holds. All texels are marched where the plan changed, since they move;
/// where only their inputs changed, and the update fraction is a quarter at most, in four frames, of each 2x2
/// texels one a frame.
class SmokeShadowCache {
 public:
  /// The update of a frame that has `plan`; nothing where all texels hold. From `commit` on it counts as
  /// done.
  std::optional<SmokeShadowUpdate> update(const SmokeShadowPlan& plan, const SmokeShadowInputs& inputs,
                                          Allocator memory = {});
  /// The frame of the last update was recorded.
  void commit() { state_.commit(); }
  /// The device lost its atlas.
  void invalidate() { state_.reset().has_texels = false; }

 private:
  /// What the texels are marched from, byte by byte: equal keys, equal shadows.
  static void add_inputs(const SmokeShadowInputs& inputs, InputKey& key);

  struct State {
    UpdateScheduler scheduler{4};
    SmokeShadowPlan plan;
    bool has_texels = false;
    InputKey key;
  };
  Proposed<State> state_;
};

}  // namespace brume::planning
