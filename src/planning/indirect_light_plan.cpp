#include "planning/indirect_light_plan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace brume::planning {
namespace {

InputKey key_of(const FrameInput& input, std::uint32_t bounces, const MediaPlan& media, const HolePlan& holes,
                std::span<const shared::Light> lights, Allocator memory) {
  InputKey key(memory);
  key.add(bounces);
  key.add(input.environment.sky.ambient);
  for (const shared::Light& light : lights) key.add(light);
  if (const smoke::SmokeVolume* smoke = input.smoke.volume; smoke && smoke->slot_count() > 0) {
    key.add(smoke->id());
    key.add(smoke->revision());
    key.add(input.smoke.look.albedo);
    key.add(input.smoke.look.extinction);
    key.add(input.smoke.look.erosion);
    key.add(input.smoke.look.noise_frequency);
    key.add(input.smoke.look.detail);
    key.add(input.smoke.look.multiple_scattering);
    key.add(input.smoke.look.phase);
    for (const shared::Hole& hole : holes.holes) key.add(hole);
    if (!holes.holes.empty()) key.add(holes.time);  // they open and close
  }
  add_casters(key, media, input.volumes);
  return key;
}

}  // namespace

IndirectLightPlan IndirectLightCache::plan(const FrameInput& input, const MediaPlan& media,
                                           const HolePlan& holes, std::span<const shared::Light> lights,
                                           Allocator memory) {
  IndirectLightPlan plan{.lights = FrameVector<shared::Light>(memory)};
  const std::uint32_t bounces = input.environment.bounces;
  if (!input.level.voxels.grid || bounces == 0) return plan;
  plan.bounces = bounces;
  plan.lights.assign(lights.begin(), lights.end());
  plan.media = media.caster_bounds;
  State& next = state_.propose();
  plan.level_changed = !next.has_level || !(input.level.voxels == next.level) ||
                       input.level.hidden_objects != next.hidden_objects;
  next.level = input.level.voxels;
  next.hidden_objects = input.level.hidden_objects;
  next.has_level = true;
  if (plan.level_changed) next.shown.clear();

  // What is being found goes on, unless it must be there at once or the number of its bounces changed.
  const InputKey key = key_of(input, bounces, media, holes, lights, memory);
  const float fraction =
      std::min(input.quality.light_update_fraction, input.quality.indirect_update_fraction);
  const bool at_once = next.shown.empty() || fraction >= 1;
  const bool changed = key != next.shown || input.quality.rebuild_light;
  if (changed && (next.solving.empty() || at_once || plan.bounces != next.bounces)) {
    next.solving = key;
    next.next_slice = 0;
  } else if (!changed && at_once) {
    next.solving.clear();
  }
  next.bounces = plan.bounces;
  if (!next.solving.empty()) plan.slices = next_slices(next, at_once ? 1 : fraction);
  plan.version = next.version;
  return plan;
}

/// The next slices of what is being found; it shows after the last one.
volume::IndexRange IndirectLightCache::next_slices(State& state, float fraction) {
  const std::uint32_t all = state.bounces * kSlicesPerBounce;
  const auto due = static_cast<std::uint32_t>(std::ceil(fraction * static_cast<float>(all)));
  const volume::IndexRange slices{state.next_slice, std::min(due, all - state.next_slice)};
  state.next_slice += slices.count;
  if (state.next_slice == all) {
    std::swap(state.shown, state.solving);
    state.solving.clear();
    ++state.version;
  }
  return slices;
}

}  // namespace brume::planning
