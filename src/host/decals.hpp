// Decals of baked occlusion in a host's frames.
#pragma once

#include "host/objects.hpp"

namespace brume::host {

/// Adds the decals of a frame to `renderer.input`, with the volumes that they sample. Throws a CallFailure
/// for what brume_assets.h does not allow.
void add_decals(api::Call& call, const brume_frame_params& params, brume_renderer& renderer);

}  // namespace brume::host
