// Where smoke begins that is placed on or beside a surface.
#pragma once

#include "scenario/scenario.hpp"

namespace brume::scenario {

/// The place itself where its voxel is free. Else the centre of the nearest free voxel beside it on the same
/// side of all surfaces, one that is not below it first: smoke that is placed just above a floor begins in
/// the voxel above. The place itself where there is none: it lies in something solid.
glm::vec3 smoke_start(const Scenario& scenario, glm::vec3 place_world);

}  // namespace brume::scenario
