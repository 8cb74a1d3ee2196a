// Which bricks a frame advects the noise in, where not all of them in every frame.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "planning/update_scheduler.hpp"
#include "shared/frame.h"
#include "shared/noise_advection.h"
#include "smoke/smoke_bricks.hpp"

namespace brume::planning {

/// What the noise of a frame follows from.
struct NoiseInputs {
  const smoke::SmokeBricks* volume = nullptr;    ///< Not null.
  std::span<const std::uint32_t> slots;          ///< Of the smoke that is visible or casts visible shadows.
  std::span<const shared::CloudMotion> motions;  ///< Of the state's clouds.
  std::span<const shared::Impulse> impulses;
  shared::SmokeLook look{};
  float time = 0;  ///< [s]
};

/// Time-sliced noise: a frame advects the noise in a quarter of the bricks. Never late are bricks that come
/// into view or whose densities changed, and those that a shot, a body or an explosion moves; all bricks are
/// due while a cloud blooms, and all that remain where a frame of the same time is drawn again.
class NoiseUpdates {
 public:
  /// Whether frames of this light_update_fraction take one slice, and require `slots_due`.
  bool applies_to(float light_update_fraction) const {
    return scheduler_.takes_one_slice(light_update_fraction);
  }
  /// The slots whose noise the frame must advect, in their order; they count as up to date from then on.
  /// Valid until the next call.
  std::span<const std::uint32_t> slots_due(const NoiseInputs& inputs);
  /// Whether some noise of the last frame, unless invalidated, is of an earlier time: not all slots were due.
  bool is_late() const { return last_ && scheduler_.pending() > 0; }
  /// The noise was advected without this class, or not at all.
  void invalidate() { last_.reset(); }

 private:
  struct Last {
    std::uint64_t volume = 0;  // its id
    std::uint64_t revision = 0;
    shared::VolumeLayout layout{};
    shared::SmokeLook look{};
    float time = 0;
  };
  bool all_are_due(const NoiseInputs& inputs) const;
  void mark_changed(const NoiseInputs& inputs);
  void mark_moved(const NoiseInputs& inputs, std::span<const shared::Impulse> impulses);
  void store_inputs(const NoiseInputs& inputs);

  UpdateScheduler scheduler_{4};
  std::optional<Last> last_;
  std::vector<shared::CloudMotion> motions_;
  std::vector<shared::Impulse> impulses_;
  std::vector<std::uint64_t> last_frame_;  // of each slot, the last frame that had it
  std::vector<std::uint8_t> changed_;      // of each slot, in this frame
  std::vector<std::uint32_t> slots_due_;
  std::uint64_t frames_ = 0;
};

}  // namespace brume::planning
