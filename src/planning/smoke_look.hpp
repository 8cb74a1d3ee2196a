// How smoke looks, in the form that shaders read.
#pragma once

#include "scene/smoke_options.hpp"
#include "shared/frame.h"
#include "smoke/field.hpp"

namespace brume::planning {

/// `voxel_size`: of the level [m].
shared::SmokeLook smoke_look(const scene::SmokeOptions& options, float voxel_size);
/// What lines of sight pass; `drawn`: as pictures show it.
smoke::SightLook sight_look(const scene::SmokeOptions& options, float voxel_size, bool drawn);

}  // namespace brume::planning
