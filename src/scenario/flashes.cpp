#include "scenario/flashes.hpp"

#include <algorithm>

#include "scenario/ticks.hpp"
#include "scene/event_fields.hpp"

namespace brume::scenario {
namespace {

constexpr float kLeastIntensity = 0.01f;

/// Remaining fraction of a flash's duration, in (0, 1]; 0 before and after.
float remaining_fraction(double event_time, double seconds, double duration) {
  const std::uint32_t ticks_per_second = sim::WorldSettings{}.ticks_per_second;
  const double age = seconds - tick_at(event_time, ticks_per_second) / static_cast<double>(ticks_per_second);
  return age >= 0 && age < duration ? static_cast<float>(1 - age / duration) : 0.0f;
}

void add_flash(std::vector<shared::Light>& lights, glm::vec3 position_world, float intensity,
               glm::vec3 color) {
  if (intensity < kLeastIntensity) return;
  shared::Light light{};
  light.position_world = position_world;
  light.intensity = intensity * color;
  light.range = shared::light_range(intensity);
  light.kind = shared::kLightPoint;
  light.direction = {0, -1, 0};
  light.shadow_layer = shared::kShadowByVoxels;
  lights.push_back(light);
}

}  // namespace

std::vector<shared::Light> flashes_of(const scene::Timeline& timeline, double seconds) {
  std::vector<shared::Light> lights;
  scene::for_each_event_list(timeline, [&](const char*, const auto& events) {
    for (const auto& event : events)
      if constexpr (requires { scene::flash_of(event); }) {
        const scene::EventFlash flash = scene::flash_of(event);
        const float remaining = remaining_fraction(event.time, seconds, flash.seconds);
        add_flash(lights, flash.at_world, event.flash * remaining * remaining,
                  flash.first_color == flash.last_color
                      ? flash.first_color
                      : glm::mix(flash.last_color, flash.first_color, remaining));
      }
  });
  return lights;
}

}  // namespace brume::scenario
