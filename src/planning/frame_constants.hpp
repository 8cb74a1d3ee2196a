// What every pass may read of a frame.
#pragma once

#include "planning/frame_plan.hpp"

namespace brume::planning {

/// Without the layouts of what only a device holds: FrameConstants::solid, indirect and march_scale.
shared::FrameConstants frame_constants(const FramePlan& plan);

}  // namespace brume::planning
