#include "planning/smoke_light_cache.hpp"

#include <algorithm>

namespace brume::planning {

void SmokeLightCache::invalidate() {
  pages_.clear();
  stale_.reset();
}

/// At least what the plan will allocate: what all bricks in view need, less what they have.
SmokeLightCache::Missing SmokeLightCache::missing(const SmokeVisibility& visibility) const {
  Missing missing;
  for (std::uint32_t i = 0; i < visibility.visible_count; ++i) {
    const LitBrick* brick = pages_.find(visibility.slots[i]);
    const auto lights = lights_.reaching(i);
    missing.pages += lights.size() + (brick ? 0 : shared::kSkyPages);
    missing.bricks += brick ? 0 : 1;
    if (!brick) continue;
    for (const CachedRays& rays : brick->lights)
      missing.pages -= std::ranges::find(lights, rays.light) != lights.end();
  }
  return missing;
}

/// Whether the device can add what is missing to what it holds.
bool SmokeLightCache::has_room(const SmokeLightInputs& inputs) const {
  const Missing more = missing(*inputs.visibility);
  return pages_.fits(more.pages) && pages_.page_count() + more.pages <= inputs.room.pages &&
         pages_.brick_count() + more.bricks <= inputs.room.texel_lists;
}

void SmokeLightCache::add_brick(const SmokeLightInputs& inputs, std::size_t visible_index) {
  const std::uint32_t slot = inputs.visibility->slots[visible_index];
  LitBrick& brick = pages_.acquire(slot, inputs.volume->brick_of(slot));
  schedule_.add(brick, lights_.reaching(visible_index), lights_, stale_, pages_);
}

void SmokeLightCache::plan_incremental(const SmokeLightInputs& inputs) {
  for (std::uint32_t i = 0; i < inputs.visibility->visible_count; ++i) add_brick(inputs, i);
  schedule_.end_part(pages_);
}

/// Plans the bricks in parts, each with as many bricks as pages suffice for. Nothing stays cached.
void SmokeLightCache::plan_in_parts(const SmokeLightInputs& inputs) {
  schedule_.update_all();
  const auto end_part = [&] {
    schedule_.end_part(pages_);
    pages_.clear();
  };
  for (std::uint32_t i = 0; i < inputs.visibility->visible_count; ++i) {
    const std::size_t most_pages = lights_.reaching(i).size() + shared::kSkyPages;
    if (pages_.page_count() > 0 && !pages_.fits(most_pages)) end_part();
    add_brick(inputs, i);
  }
  end_part();
}

const SmokeLightPlan& SmokeLightCache::plan(const SmokeLightInputs& inputs, Allocator memory) {
  // After a plan that was not committed the device may hold anything.
  if (is_open_) invalidate();
  is_open_ = true;
  if (!inputs.volume || inputs.volume->slot_count() == 0) {
    schedule_.clear();
    invalidate();
    return schedule_.plan();
  }

  // What changed since the previous frame.
  schedule_.begin(inputs.update_fraction);
  stale_.mark(inputs, lights_, schedule_.is_sliced(), pages_, memory);
  if (stale_.surroundings_changed(inputs)) schedule_.change_surroundings();
  lights_.match(inputs.lights);
  for (const std::uint32_t light : lights_.renumbered()) pages_.forget_light(light);
  lights_.find_in_reach(*inputs.volume, *inputs.visibility, memory);

  // What the frame updates: all bricks in view at once, or in parts where they do not even fit empty pages.
  if (!has_room(inputs)) pages_.clear();
  if (pages_.page_count() == 0 && !pages_.fits(missing(*inputs.visibility).pages)) {
    plan_in_parts(inputs);
    stale_.reset();
  } else {
    plan_incremental(inputs);
    stale_.store(inputs);
  }
  return schedule_.plan();
}

}  // namespace brume::planning
