// Short-lived lights: muzzle flashes and explosions.
#pragma once

#include <vector>

#include "scene/timeline.hpp"
#include "shared/light.h"

namespace brume::scenario {

/// Duration of a muzzle flash and of an explosion's light, from the tick of the event [s].
constexpr double kMuzzleSeconds = 0.06, kBlastSeconds = 0.3;
/// Distance of a muzzle flash ahead of the shot's origin [m].
constexpr float kMuzzleAhead = 0.3f;
/// Height of an explosion's light above its position, which may be on the ground [m].
constexpr float kBlastAbove = 0.4f;

/// The lights at a time [s], in the order of the timeline's shots, then of its blasts: point lights shadowed
/// by voxels (kShadowByVoxels), none darker than 1/100 W/sr. Each starts at its event's `flash` and fades
/// with the square of the remaining time.
std::vector<shared::Light> flashes_of(const scene::Timeline& timeline, double seconds);

}  // namespace brume::scenario
