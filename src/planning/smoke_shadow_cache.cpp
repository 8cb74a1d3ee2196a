#include "planning/smoke_shadow_cache.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>

namespace brume::planning {
namespace {

template <typename T>
bool same_bytes(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && (a.empty() || std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0);
}

/// What of the look the noise in the density depends on (shaders/noise_advection.comp).
shared::SmokeLook noise_look_of(const shared::SmokeLook& look) {
  shared::SmokeLook noise{};
  noise.erosion = look.erosion;
  noise.noise_frequency = look.noise_frequency;
  noise.detail = look.detail;
  noise.rise = look.rise;
  noise.swirl = look.swirl;
  noise.swirl_width = look.swirl_width;
  return noise;
}

}  // namespace

bool SmokeShadowCache::Key::operator==(const Key& other) const {
  return volume == other.volume && revision == other.revision && slots == other.slots &&
         caster_bounds.low == other.caster_bounds.low && caster_bounds.high == other.caster_bounds.high &&
         same_bytes(lights, other.lights) && extinction == other.extinction && erosion == other.erosion &&
         std::memcmp(&noise_look, &other.noise_look, sizeof noise_look) == 0 &&
         same_bytes(motions, other.motions) && same_bytes(impulses, other.impulses) &&
         noise_time == other.noise_time && same_bytes(holes, other.holes) &&
         same_bytes(reaches, other.reaches) && hole_time == other.hole_time;
}

/// Keeps the memory of the key before.
void SmokeShadowCache::set_key(const SmokeShadowInputs& inputs, Key& key) {
  key.volume = key.revision = 0;
  key.slots.clear();
  key.caster_bounds = {};
  key.lights.clear();
  key.extinction = key.erosion = key.noise_time = key.hole_time = 0;
  key.noise_look = {};
  key.motions.clear();
  key.impulses.clear();
  key.holes.clear();
  key.reaches.clear();
  if (!inputs.volume) return;
  key.volume = inputs.volume->volume().id();
  key.revision = inputs.volume->revision();

  // Rays end at the caster bounds, and only these slots have this frame's density.
  const SmokeVisibility& visibility = *inputs.visibility;
  const auto casters = visibility.slots.begin() + static_cast<std::ptrdiff_t>(visibility.visible_count);
  std::merge(visibility.slots.begin(), casters, casters, visibility.slots.end(),
             std::back_inserter(key.slots));
  key.caster_bounds = visibility.caster_bounds;
  key.lights.assign(inputs.lights.begin(), inputs.lights.end());
  for (shared::Light& light : key.lights) light.intensity = glm::vec3(0);

  // The clock counts only where noise or holes move with it.
  key.extinction = inputs.look.extinction;
  key.erosion = inputs.look.erosion;
  if (inputs.look.erosion > 0) {
    key.noise_look = noise_look_of(inputs.look);
    key.motions.assign(inputs.noise->motion.clouds.begin(), inputs.noise->motion.clouds.end());
    key.impulses.assign(inputs.noise->motion.impulses.begin(), inputs.noise->motion.impulses.end());
    key.noise_time = inputs.time;
  }
  key.holes.assign(inputs.holes->holes.begin(), inputs.holes->holes.end());
  key.reaches.assign(inputs.holes->reaches.begin(), inputs.holes->reaches.end());
  if (!key.holes.empty()) key.hole_time = inputs.holes->time;
}

std::optional<SmokeShadowUpdate> SmokeShadowCache::update(const SmokeShadowPlan& plan,
                                                          const SmokeShadowInputs& inputs, Allocator memory) {
  // What changed. Time-sliced noise changes after its inputs did, too.
  set_key(inputs, next_key_);
  const bool noise_changed = inputs.look.erosion > 0 && inputs.noise->catches_up;
  const bool same_plan = has_texels_ && plan == plan_;
  const bool same_inputs =
      has_texels_ && next_key_ == key_ && !inputs.rebuild && !(inputs.volume && noise_changed);
  plan_ = plan;
  std::swap(key_, next_key_);
  has_texels_ = true;

  // Texels of one frame lie beside those of the others.
  constexpr std::array<glm::uvec2, 4> kFirstTexels{{{1, 1}, {0, 1}, {1, 0}, {0, 0}}};
  if (!same_plan || !same_inputs) scheduler_.restart();
  if (scheduler_.pending() == 0) return std::nullopt;
  if (!same_plan || !scheduler_.takes_one_slice(inputs.update_fraction)) {
    scheduler_.complete();
    return SmokeShadowUpdate{plan_.spread_by(1, memory), 1, glm::uvec2(0)};
  }
  scheduler_.next_slice(inputs.update_fraction);
  scheduler_.complete_slice();
  return SmokeShadowUpdate{plan_.spread_by(2, memory), 2, kFirstTexels[scheduler_.slices().first]};
}

}  // namespace brume::planning
