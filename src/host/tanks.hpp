// Tanks of spheres in a host's frames.
#pragma once

#include "host/objects.hpp"
#include "render/tank_layer.hpp"

namespace brume::host {

/// The tanks of a frame. Throws a CallFailure for what brume_assets.h does not allow.
std::vector<render::TankInput> tanks_of(api::Call& call, const brume_frame_params& params);

}  // namespace brume::host
