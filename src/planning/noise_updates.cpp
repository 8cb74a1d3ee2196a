#include "planning/noise_updates.hpp"

#include <algorithm>
#include <cstring>

#include "planning/light_reach.hpp"

namespace brume::planning {

bool NoiseUpdates::all_are_due(const NoiseInputs& inputs) const {
  if (!last_ || last_->volume != inputs.volume) return true;
  const shared::VolumeLayout& layout = inputs.volume->layout();
  if (layout.origin_world != last_->layout.origin_world || layout.voxel_size != last_->layout.voxel_size ||
      layout.atlas_bricks != last_->layout.atlas_bricks ||
      std::memcmp(&inputs.look, &last_->look, sizeof inputs.look) != 0)
    return true;
  // What is dirty is only that since the revision before.
  if (inputs.volume->revision() != last_->revision && inputs.volume->revision() != last_->revision + 1)
    return true;
  // A front that moves carries the noise with it.
  return !std::equal(motions_.begin(), motions_.end(), inputs.motions.begin(), inputs.motions.end(),
                     [](const auto& a, const auto& b) { return a.front == b.front; });
}

/// Marks the bricks that impulses come near.
void NoiseUpdates::mark_moved(const NoiseInputs& inputs, std::span<const shared::Impulse> impulses) {
  const shared::VolumeLayout& layout = inputs.volume->layout();
  const float edge = layout.voxel_size * float{shared::kBrickVoxels};
  for (const shared::Impulse& push : impulses) {
    const float reach = push.radius + layout.voxel_size;  // a brick has one texel around it
    for (const std::uint32_t slot : inputs.slots) {
      const glm::vec3 low = layout.origin_world + edge * glm::vec3(inputs.volume->brick_of(slot));
      if (intersects_box(push.from_world, push.to_world, low - reach, low + edge + reach)) moved_[slot] = 1;
    }
  }
}

void NoiseUpdates::remember(const NoiseInputs& inputs) {
  last_ = {inputs.volume, inputs.volume->revision(), inputs.volume->layout(), inputs.look, inputs.time};
  motions_.assign(inputs.motions.begin(), inputs.motions.end());
  impulses_.assign(inputs.impulses.begin(), inputs.impulses.end());
}

std::span<const std::uint32_t> NoiseUpdates::due(const NoiseInputs& inputs) {
  ++frames_;
  const bool all = all_are_due(inputs);
  if (all) left_ = 0;
  const bool stands = !all && inputs.time == last_->time;
  if (!all && !stands) left_ = kSlices;
  moved_.assign(inputs.volume->slot_count(), all ? 1 : 0);
  if (all) {
    seen_.clear();
  } else {
    const bool same_impulses =
        std::equal(impulses_.begin(), impulses_.end(), inputs.impulses.begin(), inputs.impulses.end(),
                   [](const auto& a, const auto& b) { return std::memcmp(&a, &b, sizeof a) == 0; });
    if (!same_impulses) mark_moved(inputs, impulses_);
    if (!same_impulses) mark_moved(inputs, inputs.impulses);
    if (inputs.volume->revision() != last_->revision) {
      for (const std::uint32_t slot : inputs.volume->dirty_slots()) moved_[slot] = 1;
      for (const std::uint32_t slot : inputs.volume->dirty_cell_slots()) moved_[slot] = 1;
    }
  }
  seen_.resize(inputs.volume->slot_count());
  due_.clear();
  for (const std::uint32_t slot : inputs.slots) {
    const bool is_new = seen_[slot] + 1 != frames_;
    const bool is_scheduled = left_ > 0 && (stands || slot % kSlices == frames_ % kSlices);
    if (moved_[slot] != 0 || is_new || is_scheduled) due_.push_back(slot);
    seen_[slot] = frames_;
  }
  left_ = stands ? 0 : left_ - (left_ > 0);
  remember(inputs);
  return due_;
}

}  // namespace brume::planning
