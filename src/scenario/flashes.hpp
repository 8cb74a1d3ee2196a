// Light that is there for a moment: what a muzzle and an explosion throw on all around.
#pragma once

#include <vector>

#include "scene/timeline.hpp"
#include "shared/light.h"

namespace brume::scenario {

/// How long a muzzle and an explosion shine, from the tick of the event on [s].
constexpr double kMuzzleSeconds = 0.06, kBlastSeconds = 0.3;
/// A muzzle's light is this far before the place that is shot from [m].
constexpr float kMuzzleAhead = 0.3f;
/// An explosion's light is this far over its place, which may be on the ground [m].
constexpr float kBlastAbove = 0.4f;

/// The lights that shine at a time [s], in the order of the timeline's shots, then of its blasts: point
/// lights shadowed by voxels (kShadowByVoxels), none darker than 1/100 W/sr. Each begins at its event's
/// `flash` and fades as the square of the time that is left.
std::vector<shared::Light> flashes_of(const scene::Timeline& timeline, double seconds);

}  // namespace brume::scenario
