// Light in the voxels of a painted tank: what passes exactly, voxel by voxel.
#pragma once

#include <glm/glm.hpp>
#include <span>

#include "spheres/tank.hpp"

namespace brume::spheres {

/// The fraction of a point light that reaches a voxel's middle through a painted tank of `size` (paint()):
/// each voxel on the segment but the voxel itself transmits (1 - a / 255)^length, length in voxels, nothing
/// where a is 255. Voxels by shared/dda.h; the light, in voxels, may be outside of the tank, within 2^20.
/// What faster light passes are compared with: O(voxels along the segment).
double exact_light(std::span<const Color> paint, const glm::uvec3& size, const glm::vec3& light_voxel,
                   const glm::ivec3& voxel);

}  // namespace brume::spheres
