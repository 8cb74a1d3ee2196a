// The lights of a scene in the form that shaders and culling read.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "scene/scene.hpp"
#include "shared/light.h"

namespace brume::planning {

/// Lights for the device: ranges cut off less than scene::Light::least; point lights and spots get six shadow
/// layers each, in order, up to `max_layers`; the first sun has a map of its own, and layer 0.
std::vector<shared::Light> device_lights(const std::vector<scene::Light>& lights, std::uint32_t max_layers);

/// The places in a frame's plan of up to four lights, which are numbered through the scene's and then the
/// frame's flashes; shared::kNoLight: it reaches nothing in view, or there is none.
glm::uvec4 planned_lights(std::span<const shared::Light> planned, std::span<const shared::Light> scene,
                          std::span<const shared::Light> flashes, std::span<const std::uint32_t> lights);

/// Whether any of them is shadowed by voxels.
bool has_voxel_shadows(std::span<const shared::Light> lights);

}  // namespace brume::planning
