#include "planning/noise_updates.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "planning/light_reach.hpp"

namespace brume::planning {
namespace {

/// The slice of a slot: slots side by side, which often hold bricks side by side, are in different ones.
std::uint32_t slice_of(std::uint32_t slot) {
  constexpr std::array<std::uint32_t, 4> kSlices{3, 0, 2, 1};
  return kSlices[slot % kSlices.size()];
}

}  // namespace

bool NoiseUpdates::all_are_due(const NoiseInputs& inputs) const {
  if (!last_ || last_->volume != inputs.volume->volume().id()) return true;
  const shared::VolumeLayout& layout = inputs.volume->layout();
  if (layout.origin_world != last_->layout.origin_world || layout.voxel_size != last_->layout.voxel_size ||
      layout.bricks.atlas_bricks != last_->layout.bricks.atlas_bricks ||
      std::memcmp(&inputs.look, &last_->look, sizeof inputs.look) != 0)
    return true;
  // The dirty slots are those since the revision before, no older ones.
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
  for (const shared::Impulse& impulse : impulses) {
    const float reach = impulse.radius + layout.voxel_size;  // a brick has one texel around it
    for (const std::uint32_t slot : inputs.slots) {
      const glm::vec3 low = layout.origin_world + edge * glm::vec3(inputs.volume->brick_of(slot));
      if (intersects_box(impulse.from_world, impulse.to_world, low - reach, low + edge + reach))
        changed_[slot] = 1;
    }
  }
}

/// Marks the bricks whose densities changed, and those that impulses move now or moved before.
void NoiseUpdates::mark_changed(const NoiseInputs& inputs) {
  const bool same_impulses =
      std::equal(impulses_.begin(), impulses_.end(), inputs.impulses.begin(), inputs.impulses.end(),
                 [](const auto& a, const auto& b) { return std::memcmp(&a, &b, sizeof a) == 0; });
  if (!same_impulses) mark_moved(inputs, impulses_);
  if (!same_impulses) mark_moved(inputs, inputs.impulses);
  if (inputs.volume->revision() == last_->revision) return;
  for (const std::uint32_t slot : inputs.volume->dirty_slots()) changed_[slot] = 1;
  for (const std::uint32_t slot : inputs.volume->dirty_cell_slots()) changed_[slot] = 1;
}

void NoiseUpdates::store_inputs(const NoiseInputs& inputs) {
  last_ = {inputs.volume->volume().id(), inputs.volume->revision(), inputs.volume->layout(), inputs.look,
           inputs.time};
  motions_.assign(inputs.motions.begin(), inputs.motions.end());
  impulses_.assign(inputs.impulses.begin(), inputs.impulses.end());
}

std::span<const std::uint32_t> NoiseUpdates::slots_due(const NoiseInputs& inputs) {
  ++frames_;
  scheduler_.next_slice(1.0f / static_cast<float>(scheduler_.slice_count()));

  // What changed of each slot.
  const bool all = all_are_due(inputs);
  const bool same_time = !all && inputs.time == last_->time;
  changed_.assign(inputs.volume->slot_count(), all ? 1 : 0);
  if (all) last_frame_.clear();
  last_frame_.resize(inputs.volume->slot_count());
  if (!all) mark_changed(inputs);

  // The slots of the frame's slice; of all slices where time stands still.
  if (all) scheduler_.complete();
  if (!all && !same_time) scheduler_.restart();
  const bool is_pending = scheduler_.pending() > 0;
  const std::uint32_t slice = scheduler_.slices().first;
  slots_due_.clear();
  for (const std::uint32_t slot : inputs.slots) {
    const bool is_new = last_frame_[slot] + 1 != frames_;
    const bool is_scheduled = is_pending && (same_time || slice_of(slot) == slice);
    if (changed_[slot] != 0 || is_new || is_scheduled) slots_due_.push_back(slot);
    last_frame_[slot] = frames_;
  }
  if (same_time) scheduler_.complete();
  scheduler_.complete_slice();
  store_inputs(inputs);
  return slots_due_;
}

}  // namespace brume::planning
