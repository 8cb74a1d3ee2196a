// Which bricks' noise a frame carries anew, where not all of them in every frame.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "shared/noise_advection.h"
#include "shared/frame.h"
#include "smoke/smoke_volume.hpp"

namespace brume::planning {

/// What the noise of a frame follows from.
struct NoiseInputs {
  const smoke::SmokeVolume* volume = nullptr;      ///< Not null.
  std::span<const std::uint32_t> slots;          ///< That the frame needs.
  std::span<const shared::CloudMotion> motions;  ///< Of the state's clouds.
  std::span<const shared::Impulse> impulses;
  shared::SmokeLook look{};
  float time = 0;  ///< [s]
};

/// Bricks take turns, a quarter of them a frame. At once come those that are new to the view or whose
/// densities changed, and those that a shot, a body or an explosion moves; all of them while a cloud blooms,
/// and all that are left where a inputs is drawn again.
class NoiseUpdates {
 public:
  static constexpr std::uint32_t kSlices = 4;

  /// The slots of the frame that are to be carried anew, in their order; counts as done from then on. Holds
  /// until the next call.
  std::span<const std::uint32_t> due(const NoiseInputs& inputs);
  /// Somebody else carried the noise, or nobody.
  void forget() { last_.reset(); }

 private:
  struct Last {
    const smoke::SmokeVolume* volume = nullptr;
    std::uint64_t revision = 0;
    shared::VolumeLayout layout{};
    shared::SmokeLook look{};
    float time = 0;
  };
  bool all_are_due(const NoiseInputs& inputs) const;
  void mark_moved(const NoiseInputs& inputs, std::span<const shared::Impulse> impulses);
  void remember(const NoiseInputs& inputs);

  std::optional<Last> last_;
  std::vector<shared::CloudMotion> motions_;
  std::vector<shared::Impulse> impulses_;
  std::vector<std::uint64_t> seen_;  // of each slot, the last frame that needed it
  std::vector<std::uint8_t> moved_;  // of each slot, in this frame
  std::vector<std::uint32_t> due_;
  std::uint64_t frames_ = 0;
  std::uint32_t left_ = 0;  // turns until all are as of a inputs
};

}  // namespace brume::planning
