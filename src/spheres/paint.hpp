// Colours of a tank's voxels.
#pragma once

#include <vector>

#include "spheres/tank.hpp"

namespace brume::spheres {

/// The colour of each voxel, x fastest: that of the sphere whose shared::sphere_power of the voxel's middle
/// is below 0, of two that touch there the one of the lower id; 0 where none is. Row by row of each sphere,
/// on all cores; the same for any number of threads.
std::vector<Color> paint(const Tank& tank);

}  // namespace brume::spheres
