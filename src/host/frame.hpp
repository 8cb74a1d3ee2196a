// Parameters of the host, checked, in the form that the renderer takes.
#pragma once

#include <brume/brume_vulkan.h>

#include "api/smoke_field.hpp"
#include "render/renderer.hpp"

namespace brume::host {

/// All throw a CallFailure for what brume_vulkan.h does not allow.
scene::Light scene_light(const brume_light& light, std::size_t number);
scene::Scene scene_of(const brume_renderer_params& params);
passes::HostDepthRange depth_range(const brume_depth& depth);
/// What the result points to is the field's.
planning::FrameInput frame_input(const brume_frame_params& params, const api::SmokeField& field);

}  // namespace brume::host
