// The direction that a cloud's smoke spread in: it carries the noise outward while the cloud blooms.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "sim/cloud.hpp"

namespace brume::smoke {

/// By rank in cloud.voxels(): a vector along the last straight segment of a short path from the source to the
/// voxel, as long as the whole path [voxels]. In the open that is the voxel less the source; behind a corner
/// it points away from the corner. Paths are found at any angle (Lazy Theta*: Nash, Koenig and Tovey 2010,
/// "Lazy Theta*: Any-Angle Path Planning and Path Length Analysis in 3D") in the order of the cloud's own
/// distances, and cross no voxel that it does not fill. 0 for detached voxels. Where the box around the cloud
/// holds more than 2^26 voxels all paths are straight.
std::vector<glm::vec3> growth_of(const sim::Cloud& cloud);

}  // namespace brume::smoke
