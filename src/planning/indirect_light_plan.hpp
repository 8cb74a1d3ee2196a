// Which indirect light a frame has (shaders/shared/indirect_light.h), and whether the light of the frame
// before holds.
#pragma once

#include <cstddef>
#include <vector>

#include "core/box.hpp"
#include "planning/hole_plan.hpp"
#include "planning/input_key.hpp"
#include "planning/media_plan.hpp"
#include "planning/proposed.hpp"
#include "volume/range_arena.hpp"

namespace brume::planning {

struct IndirectLightPlan {
  std::uint32_t bounces = 0;          ///< 0: there is none.
  FrameVector<shared::Light> lights;  ///< All of the scene and of the frame, in view or not.
  Box<float> media = kEmptyBox;       ///< MediaPlan::caster_bounds.
  bool level_changed = false;         ///< Walls or hidden objects, since the last plan with bounces.
  /// What is done in this frame, of bounces * kSlicesPerBounce slices; empty: the light of the frame before
  /// holds. The first slice finds the light of the lights; after the last one all light shows.
  volume::IndexRange slices{};
  std::uint64_t version = 0;  ///< Changes with the light that this frame shows.
};

/// Parts of a bounce that can be done in different frames.
constexpr std::uint32_t kSlicesPerBounce = 8;

/// Tracks what the device's indirect light was computed from. With an update fraction below 1, changed light
/// is found over several frames, from what changed it in the first of them, and shows when it is found; at
/// once where there is none to show meanwhile, and where the level changed.
class IndirectLightCache {
 public:
  /// The plan of a frame. From `commit` on it counts as done.
  IndirectLightPlan plan(const FrameInput& input, const MediaPlan& media, const HolePlan& holes,
                         std::span<const shared::Light> lights, Allocator memory = {});
  /// The frame of the last plan was recorded.
  void commit() { state_.commit(); }
  /// The device lost its light.
  void invalidate() {
    State& state = state_.reset();
    const std::uint64_t version = state.version + 1;
    state = {};
    state.version = version;
  }

 private:
  struct State {
    LevelView level;
    std::vector<std::uint32_t> hidden_objects;
    bool has_level = false;
    InputKey shown;                ///< All other inputs of the light that shows; empty: there is none.
    InputKey solving;              ///< The inputs of the light that is being found; empty: none is.
    std::uint32_t next_slice = 0;  ///< The next one of what is being found.
    std::uint32_t bounces = 0;
    std::uint64_t version = 0;
  };
  static volume::IndexRange next_slices(State& state, float fraction);

  Proposed<State> state_;
};

}  // namespace brume::planning
