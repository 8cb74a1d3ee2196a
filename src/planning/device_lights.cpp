#include "planning/device_lights.hpp"

#include <algorithm>
#include <cmath>

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
    const std::uint32_t layers = directional ? 1 : 6;
    // One orthographic view: only the first directional light casts shadows.
    if (layer + layers <= max_layers && !(directional && has_sun)) {
      l.shadow_layer = layer;
      layer += layers;
    }
    has_sun = has_sun || directional;
    out.push_back(l);
  }
  return out;
}

bool has_voxel_shadows(std::span<const shared::Light> lights) {
  return std::ranges::any_of(
      lights, [](const shared::Light& light) { return light.shadow_layer == shared::kShadowByVoxels; });
}

}  // namespace brume::planning
