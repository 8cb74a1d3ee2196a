// The first solid voxel between two points.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "smoke/sight.hpp"

namespace brume::smoke {

/// The first solid voxel that the segment from a to b [m, finite] passes, in the sense of shared/dda.h, other
/// than the voxel of a and, unless b_hides, that of b. An empty brick is one step.
std::optional<SightWall> first_solid_between(const voxel::BitGrid& grid, glm::dvec3 a_world,
                                             glm::dvec3 b_world, bool b_hides);

}  // namespace brume::smoke
