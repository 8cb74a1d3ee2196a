// Which way a cloud's smoke came: what carries the picture's noise outward while it blooms.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "sim/cloud.hpp"

namespace brume::smoke {

/// By rank in cloud.voxels(), in voxels: along the last straight stretch of a short way from the source to
/// the voxel, as long as the whole way. In the open that is the voxel less the source; behind a corner it
/// turns there. Paths are found at any angle (Lazy Theta*: Nash, Koenig and Tovey 2010, "Lazy Theta*:
/// Any-Angle Path Planning and Path Length Analysis in 3D") in the order of the cloud's own distances, and
/// cross no voxel that it does not fill. 0 for voxels of the cloud's rest. Where the box around the cloud
/// holds more than 2^26 voxels all paths are straight.
std::vector<glm::vec3> growth_of(const sim::Cloud& cloud);

}  // namespace brume::smoke
