// Which bricks a frame advects the noise in, where not all of them in every frame.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "planning/proposed.hpp"
#include "planning/update_scheduler.hpp"
#include "shared/frame.h"
#include "shared/noise_advection.h"
#include "smoke/smoke_bricks.hpp"

namespace brume::planning {

/// What the noise of a frame follows from.
struct NoiseInputs {
  const smoke::SmokeBricks* volume = nullptr;    ///< Not null.
  std::span<const std::uint32_t> slots;          ///< Smoke that is visible or casts visible shadows.
  std::span<const shared::CloudMotion> motions;  ///< How the state's clouds move.
  std::span<const shared::Impulse> impulses;
  shared::SmokeLook look{};
  float time = 0;  ///< [s]
};

/// Time-sliced noise: a frame advects the noise in a quarter of the bricks. Bricks that come into view,
/// whose densities changed, or that a shot, a body or an explosion moves are never late. All bricks are due
/// while a cloud blooms, and all that remain when a frame of the same time is drawn again.
class NoiseUpdates {
 public:
  /// Whether frames of this light_update_fraction take one slice, and require `slots_due`.
  bool applies_to(float light_update_fraction) const {
    return state_.now().scheduler.takes_one_slice(light_update_fraction);
  }
  /// The slots whose noise the frame must advect, in their order. From `commit` on they are up to date. Valid
  /// until the next call.
  std::span<const std::uint32_t> slots_due(const NoiseInputs& inputs);
  /// For a frame that advects the noise of all slots, or of none, without asking this class.
  void skip_frame() { state_.propose().last.reset(); }
  /// Whether some noise of the last frame, unless it was skipped, is of an earlier time: not all slots were
  /// due.
  bool is_late() const { return state_.now().last && state_.now().scheduler.pending() > 0; }
  /// The frame of the last slots_due or skip_frame was recorded.
  void commit() { state_.commit(); }
  /// The device lost its noise.
  void invalidate() { state_.reset().last.reset(); }

 private:
  struct Last {
    std::uint64_t volume = 0;  // its id
    std::uint64_t revision = 0;
    shared::VolumeLayout layout{};
    shared::SmokeLook look{};
    float time = 0;
  };
  /// What the noise on the device was advected with.
  struct State {
    UpdateScheduler scheduler{4};
    std::optional<Last> last;
    std::vector<shared::CloudMotion> motions;
    std::vector<shared::Impulse> impulses;
    std::vector<std::uint64_t> last_frame;  // by slot, the last frame that had it
    std::uint64_t frames = 0;
  };
  bool all_are_due(const NoiseInputs& inputs) const;
  void mark_changed(const NoiseInputs& inputs);
  void mark_moved(const NoiseInputs& inputs, std::span<const shared::Impulse> impulses);

  Proposed<State> state_;
  // Lists of the frame that is being planned.
  std::vector<std::uint8_t> changed_;  // by slot
  std::vector<std::uint32_t> slots_due_;
};

}  // namespace brume::planning
