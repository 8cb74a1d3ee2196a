// How smoke looks, in the form that shaders read.
#pragma once

#include "scene/timeline.hpp"
#include "shared/frame.h"

namespace brume::planning {

/// `voxel_size`: of the level [m].
shared::SmokeLook smoke_look(const scene::SmokeOptions& options, float voxel_size);

}  // namespace brume::planning
