// Line of sight through the smoke of pictures.
#pragma once

#include "smoke/drawn_smoke.hpp"
#include "smoke/sight.hpp"

namespace brume::smoke {

/// A Sight with the smoke that it sees. What the input points to and the level must outlive it and stay as
/// they are.
class DrawnSight {
 public:
  /// `input` has a volume. Throws what Sight does.
  DrawnSight(const SmokeInput& input, const voxel::BitGrid& level, SightSettings settings)
      : smoke_(input, smoke_noise, settings.masks),
        sight_(*input.volume, level, input.holes, input.time, with(settings, smoke_)) {}
  DrawnSight(const DrawnSight&) = delete;

  const Sight& sight() const { return sight_; }

 private:
  static SightSettings with(SightSettings settings, const DrawnSmoke& smoke) {
    settings.drawn = &smoke;
    return settings;
  }

  DrawnSmoke smoke_;
  Sight sight_;
};

}  // namespace brume::smoke
