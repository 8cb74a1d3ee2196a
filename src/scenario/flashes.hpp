// Short-lived lights: muzzle flashes and explosions.
#pragma once

#include <vector>

#include "scene/timeline.hpp"
#include "shared/light.h"

namespace brume::scenario {

/// The lights at a time [s] of the events that have one (scene::flash_of), in the order of
/// scene::for_each_event_kind and of time: point lights shadowed by voxels (kShadowByVoxels), none darker
/// than 1/100 W/sr.
std::vector<shared::Light> flashes_of(const scene::Timeline& timeline, double seconds);

}  // namespace brume::scenario
