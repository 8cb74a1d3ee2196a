// Pipelines, compiled before the frames that need them.
#pragma once

#include "host/objects.hpp"

namespace brume::host {

/// Compiles the pipelines of frames like `frame` and of renderers like `renderer`, in a context of its own:
/// the device's other contexts go on meanwhile. Throws a CallFailure for what brume_vulkan.h does not allow.
void compile(api::Call& call, DeviceData& device, const brume_renderer_params& renderer,
             const brume_frame_params& frame);

}  // namespace brume::host
