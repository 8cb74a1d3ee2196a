// Which bricks' noise a frame carries anew, where not all of them in every frame.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "shared/drift.h"
#include "shared/frame.h"
#include "sim/smoke_volume.hpp"

namespace brume::passes {

/// What the noise of a frame follows from.
struct DriftMoment {
  const sim::SmokeVolume* volume = nullptr;      ///< Not null.
  std::span<const std::uint32_t> slots;          ///< That the frame needs.
  std::span<const shared::CloudMotion> motions;  ///< Of the state's clouds.
  std::span<const shared::Push> pushes;
  shared::SmokeLook look{};
  float time = 0;  ///< [s]
};

/// Bricks take turns, a quarter of them a frame. At once come those that are new to the view or whose
/// densities changed, and those that a shot, a body or an explosion moves; all of them while a cloud blooms,
/// and all that are left where a moment is drawn again.
class DriftTurns {
 public:
  static constexpr std::uint32_t kTurns = 4;

  /// The slots of the frame that are to be carried anew, in their order; counts as done from then on. Holds
  /// until the next call.
  std::span<const std::uint32_t> due(const DriftMoment& moment);
  /// Somebody else carried the noise, or nobody.
  void forget() { last_.reset(); }

 private:
  struct Last {
    const sim::SmokeVolume* volume = nullptr;
    std::uint64_t revision = 0;
    shared::SmokeVolumeFrame frame{};
    shared::SmokeLook look{};
    float time = 0;
  };
  bool all_are_due(const DriftMoment& moment) const;
  void mark_moved(const DriftMoment& moment, std::span<const shared::Push> pushes);
  void remember(const DriftMoment& moment);

  std::optional<Last> last_;
  std::vector<shared::CloudMotion> motions_;
  std::vector<shared::Push> pushes_;
  std::vector<std::uint64_t> seen_;  // of each slot, the last frame that needed it
  std::vector<std::uint8_t> moved_;  // of each slot, in this frame
  std::vector<std::uint32_t> due_;
  std::uint64_t frames_ = 0;
  std::uint32_t left_ = 0;  // turns until all are as of a moment
};

}  // namespace brume::passes
