#include "planning/smoke_shadow_cache.hpp"

#include <algorithm>
#include <array>

namespace brume::planning {
namespace {

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

void SmokeShadowCache::add_inputs(const SmokeShadowInputs& inputs, InputKey& key) {
  key.add(inputs.volume != nullptr);
  if (!inputs.volume) return;
  key.add(inputs.volume->id());
  key.add(inputs.volume->revision());

  // Rays end at the caster bounds, and only these slots have this frame's density.
  const SmokeVisibility& visibility = *inputs.visibility;
  FrameVector<std::uint32_t> slots(visibility.slots, visibility.slots.get_allocator());
  std::sort(slots.begin(), slots.end());
  key.add_list(slots);
  key.add(visibility.caster_bounds);
  key.add(inputs.lights.size());
  for (shared::Light light : inputs.lights) {
    light.intensity = glm::vec3(0);  // rays do not depend on it
    key.add(light);
  }

  // The clock counts only where noise or holes move with it.
  key.add(inputs.look.extinction);
  key.add(inputs.look.erosion);
  if (inputs.look.erosion > 0) {
    key.add(noise_look_of(inputs.look));
    add_motion(key, inputs.noise->motion);
    key.add(inputs.time);
  }
  key.add_list(inputs.holes->holes);
  key.add_list(inputs.holes->reaches);
  if (!inputs.holes->holes.empty()) key.add(inputs.holes->time);
}

std::optional<SmokeShadowUpdate> SmokeShadowCache::update(const SmokeShadowPlan& plan,
                                                          const SmokeShadowInputs& inputs, Allocator memory) {
  // What changed. Time-sliced noise changes after its inputs did, too.
  const State& before = state_.now();
  InputKey key(memory);
  add_inputs(inputs, key);
  const bool noise_changed = inputs.look.erosion > 0 && inputs.noise->catches_up;
  const bool same_plan = before.has_texels && plan == before.plan;
  const bool same_inputs =
      before.has_texels && key == before.key && !inputs.rebuild && !(inputs.volume && noise_changed);
  State& next = state_.propose();
  next.plan = plan;
  next.key = key;
  next.has_texels = true;

  // Texels of one frame lie beside texels of the others.
  constexpr std::array<glm::uvec2, 4> kFirstTexels{{{1, 1}, {0, 1}, {1, 0}, {0, 0}}};
  if (!same_plan || !same_inputs) next.scheduler.restart();
  if (next.scheduler.pending() == 0) return std::nullopt;
  if (!same_plan || !next.scheduler.takes_one_slice(inputs.update_fraction)) {
    next.scheduler.complete();
    return SmokeShadowUpdate{plan.spread_by(1, memory), 1, glm::uvec2(0)};
  }
  next.scheduler.next_slice(inputs.update_fraction);
  next.scheduler.complete_slice();
  return SmokeShadowUpdate{plan.spread_by(2, memory), 2, kFirstTexels[next.scheduler.slices().first]};
}

}  // namespace brume::planning
