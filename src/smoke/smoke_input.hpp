// What the smoke of a picture is drawn from.
#pragma once

#include <span>

#include "shared/frame.h"
#include "shared/hole.h"
#include "sim/state.hpp"
#include "smoke/smoke_volume.hpp"

namespace brume::smoke {

struct SmokeInput {
  const SmokeVolume* volume = nullptr;  ///< null: no smoke.
  /// The state whose events advect the noise; null: it only rises.
  const sim::State* state = nullptr;
  std::span<const shared::Hole> holes;  ///< At most shared::kMaxHoles are cut, the last ones.
  shared::SmokeLook look{};
  double swirl_period = 12;  ///< How long the noise takes to roll around once [s]; > 0.
  float time = 0;            ///< The clock of the holes and of the noise [s].
};

}  // namespace brume::smoke
