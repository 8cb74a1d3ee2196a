// Tanks of spheres in a host's frames.
#pragma once

#include "host/objects.hpp"

namespace brume::host {

/// Adds the tanks of a frame. Throws a CallFailure for what brume_assets.h does not allow.
void add_tanks(api::Call& call, const brume_frame_params& params, planning::FrameInput& frame);

}  // namespace brume::host
