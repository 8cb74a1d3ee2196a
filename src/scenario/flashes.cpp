#include "scenario/flashes.hpp"

#include <algorithm>

#include "scenario/events.hpp"
#include "sim/world.hpp"

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
  // Burning powder, and a fireball that fades from yellow to red.
  constexpr glm::vec3 kMuzzle{1, 0.68f, 0.34f}, kFire{1, 0.72f, 0.38f}, kEmbers{1, 0.34f, 0.08f};
  std::vector<shared::Light> lights;
  for (const scene::ShotEvent& shot : timeline.shots) {
    const float remaining = remaining_fraction(shot.time, seconds, kMuzzleSeconds);
    const glm::vec3 ahead = kMuzzleAhead * glm::normalize(shot.toward_world - shot.from_world);
    add_flash(lights, shot.from_world + ahead, shot.flash * remaining * remaining, kMuzzle);
  }
  for (const scene::BlastEvent& blast : timeline.blasts) {
    const float remaining = remaining_fraction(blast.time, seconds, kBlastSeconds);
    add_flash(lights, blast.at_world + glm::vec3(0, kBlastAbove, 0), blast.flash * remaining * remaining,
              glm::mix(kEmbers, kFire, remaining));
  }
  return lights;
}

}  // namespace brume::scenario
