// The light of flames: what glows in volumes lights all around it.
#pragma once

#include <vector>

#include "shared/light.h"
#include "volumes/volumes.hpp"

namespace brume::planning {

/// A light for each ball of glow in a volume (grids::find_glow), of its heat and of its masks at a time [s],
/// that is seen beyond its edge at an exposure (View::exposure). Its intensity counts all that the ball emits
/// and that leaves a homogeneous ball straight, with `scattered` also what leaves after scattering.
std::vector<shared::Light> glow_lights(const scene::VolumeOptions& options, const volumes::VolumeAt& volume,
                                       double seconds, float exposure, bool scattered);

}  // namespace brume::planning
