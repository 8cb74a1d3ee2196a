#include "planning/device_lights.hpp"

#include <algorithm>
#include <cmath>

#include "core/same_bytes.hpp"
#include "shared/smoke_shadow.h"
#include "shared/surface_import.h"

namespace brume::planning {

std::vector<shared::Light> device_lights(const std::vector<scene::Light>& lights, std::uint32_t max_layers) {
  std::vector<shared::Light> out;
  std::uint32_t layer = 0;
  bool has_sun = false;
  for (const scene::Light& light : lights) {
    const float brightest = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
    shared::Light l{light.position_world,
                    shared::light_range(brightest) * std::sqrt(0.01f / light.least),
                    light.intensity,
                    static_cast<std::uint32_t>(light.kind),
                    light.direction_world,
                    light.cos_inner,
                    light.cos_outer,
                    shared::kNoShadow,
                    0,
                    0};
    const bool directional = light.kind == scene::LightKind::directional;
    // One map of the sun: only the first directional light casts shadows.
    if (directional) {
      if (!has_sun) l.shadow_layer = 0;
    } else if (layer + shared::kFacesPerLight <= max_layers) {
      l.shadow_layer = layer;
      layer += shared::kFacesPerLight;
    }
    has_sun = has_sun || directional;
    out.push_back(l);
  }
  return out;
}

glm::uvec4 planned_lights(std::span<const shared::Light> planned, std::span<const shared::Light> scene,
                          std::span<const shared::Light> flashes, std::span<const std::uint32_t> lights) {
  glm::uvec4 places(shared::kNoLight);
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const std::size_t place = lights[i];
    const shared::Light& light = place < scene.size() ? scene[place] : flashes[place - scene.size()];
    const auto found =
        std::ranges::find_if(planned, [&](const shared::Light& other) { return same_bytes(light, other); });
    if (found != planned.end())
      places[static_cast<int>(i)] = static_cast<std::uint32_t>(found - planned.begin());
  }
  return places;
}

bool has_voxel_shadows(std::span<const shared::Light> lights) {
  return std::ranges::any_of(
      lights, [](const shared::Light& light) { return light.shadow_layer == shared::kShadowByVoxels; });
}

}  // namespace brume::planning
