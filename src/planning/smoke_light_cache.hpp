// Which rays of light through the smoke a frame follows, and which cached ones still hold.
#pragma once

#include "planning/smoke_light_schedule.hpp"

namespace brume::planning {

/// Keeps the light in the smoke from frame to frame. A ray is followed again when its light, or anything that
/// may lie on it, changed (StaleLight); a brick's light is gathered again when one of its rays was followed,
/// or the eye, the sky or one of its lights changed. Where noise moves every frame changes all smoke, and all
/// rays with it. SmokeLightSchedule spreads that over frames, SmokeLightPages knows what the device holds.
class SmokeLightCache {
 public:
  explicit SmokeLightCache(std::uint32_t max_pages = kMaxRayPages) : pages_(max_pages) {}

  /// The work of a frame, valid until the next call. From `commit` on it counts as done; where that does not
  /// come before the next plan, the device may hold anything, and that plan relies on none of it.
  const SmokeLightPlan& plan(const SmokeLightInputs& inputs, Allocator memory = {});
  /// The frame of the last plan was recorded.
  void commit() { is_open_ = false; }
  /// The work of the last planned frame.
  const SmokeLightPlan& last_plan() const { return schedule_.plan(); }
  /// The device lost what it held.
  void invalidate();

 private:
  /// What bricks in view need, and the device does not hold.
  struct Missing {
    std::size_t bricks = 0, pages = 0;
  };
  Missing missing(const SmokeVisibility& visibility) const;
  bool has_room(const SmokeLightInputs& inputs) const;
  void add_brick(const SmokeLightInputs& inputs, std::size_t visible_index);
  void plan_incremental(const SmokeLightInputs& inputs);
  void plan_in_parts(const SmokeLightInputs& inputs);

  SmokeLightPages pages_;
  KnownLights lights_;
  StaleLight stale_;
  SmokeLightSchedule schedule_;
  bool is_open_ = false;  // planned, and not committed
};

}  // namespace brume::planning
