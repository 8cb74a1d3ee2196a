#include "planning/smoke_light_pages.hpp"

#include <algorithm>

namespace brume::planning {

const LitBrick* SmokeLightPages::find(std::uint32_t slot) const {
  if (slot >= brick_in_slot_.size() || brick_in_slot_[slot] == kNone) return nullptr;
  return &bricks_[brick_in_slot_[slot]];
}

LitBrick* SmokeLightPages::find(std::uint32_t slot) {
  return const_cast<LitBrick*>(std::as_const(*this).find(slot));
}

LitBrick& SmokeLightPages::acquire(std::uint32_t slot, glm::ivec3 brick) {
  if (slot >= brick_in_slot_.size()) brick_in_slot_.resize(std::size_t{slot} + 1, kNone);
  const bool is_new = brick_in_slot_[slot] == kNone;
  if (is_new) {
    brick_in_slot_[slot] = brick_count_++;
    if (bricks_.size() < brick_count_) bricks_.emplace_back();
  }
  LitBrick& lit = bricks_[brick_in_slot_[slot]];
  if (is_new) {
    lit.sky = {};
    lit.lights.clear();
  }
  if (!is_new && lit.brick == brick) return lit;
  lit.slot = slot;
  lit.number = brick_in_slot_[slot];
  lit.brick = brick;
  lit.is_listed = false;
  lit.list_version = lit.sky.list_version = lit.gathered_lights = 0;
  for (CachedRays& rays : lit.lights) rays.list_version = 0;
  return lit;
}

CachedRays& SmokeLightPages::rays_to(LitBrick& brick, std::uint32_t light, std::size_t hint) {
  if (hint < brick.lights.size() && brick.lights[hint].light == light) return brick.lights[hint];
  const auto known = std::ranges::find(brick.lights, light, &CachedRays::light);
  if (known != brick.lights.end()) return *known;
  brick.lights.emplace_back().light = light;
  return brick.lights.back();
}

void SmokeLightPages::allocate(CachedRays& rays, std::uint32_t count) {
  if (rays.page != kNone) return;
  rays.page = page_count_;
  page_count_ += count;
}

void SmokeLightPages::invalidate_rays() {
  for (LitBrick& brick : bricks()) {
    brick.sky.dirty_phases = kAllLightPhases;
    for (CachedRays& rays : brick.lights) rays.dirty_phases = kAllLightPhases;
  }
}

void SmokeLightPages::forget_light(std::uint32_t light) {
  for (LitBrick& brick : bricks())
    for (CachedRays& rays : brick.lights)
      if (rays.light == light) rays.list_version = 0;
}

void SmokeLightPages::clear() {
  brick_count_ = page_count_ = 0;
  std::ranges::fill(brick_in_slot_, kNone);
}

}  // namespace brume::planning
