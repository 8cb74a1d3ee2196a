#include "planning/noise_updates.hpp"

#include <algorithm>
#include <array>

#include "core/same_bytes.hpp"
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
  const State& before = state_.now();
  if (!before.last || before.last->volume != inputs.volume->id()) return true;
  const Last& last = *before.last;
  const shared::VolumeLayout& layout = inputs.volume->layout();
  if (layout.origin_world != last.layout.origin_world || layout.voxel_size != last.layout.voxel_size ||
      layout.bricks.atlas_bricks != last.layout.bricks.atlas_bricks || !same_bytes(inputs.look, last.look))
    return true;
  // The dirty slots are those since the revision before, no older ones.
  if (inputs.volume->revision() != last.revision && inputs.volume->revision() != last.revision + 1)
    return true;
  // At one time clouds move otherwise only where they are others, or roll at another speed.
  if (inputs.time == last.time &&
      !std::ranges::equal(before.motions, inputs.motions, same_bytes<shared::CloudMotion>))
    return true;
  // A front that moves carries the noise with it.
  return !std::ranges::equal(before.motions, inputs.motions, {}, &shared::CloudMotion::front,
                             &shared::CloudMotion::front);
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
  const State& before = state_.now();
  if (!std::ranges::equal(before.impulses, inputs.impulses, same_bytes<shared::Impulse>)) {
    mark_moved(inputs, before.impulses);
    mark_moved(inputs, inputs.impulses);
  }
  if (inputs.volume->revision() == before.last->revision) return;
  for (const std::uint32_t slot : inputs.volume->dirty_slots()) changed_[slot] = 1;
  for (const std::uint32_t slot : inputs.volume->dirty_cell_slots()) changed_[slot] = 1;
}

std::span<const std::uint32_t> NoiseUpdates::slots_due(const NoiseInputs& inputs) {
  State& state = state_.propose();
  ++state.frames;
  state.scheduler.next_slice(1.0f / static_cast<float>(state.scheduler.slice_count()));

  // What changed of each slot.
  const bool all = all_are_due(inputs);
  const bool same_time = !all && inputs.time == state.last->time;
  changed_.assign(inputs.volume->slot_count(), all ? 1 : 0);
  if (all) state.last_frame.clear();
  state.last_frame.resize(inputs.volume->slot_count());
  if (!all) mark_changed(inputs);

  // The slots of the frame's slice; of all slices where time stands still.
  if (all) state.scheduler.complete();
  if (!all && !same_time) state.scheduler.restart();
  const bool is_pending = state.scheduler.pending() > 0;
  const std::uint32_t slice = state.scheduler.slices().first;
  slots_due_.clear();
  for (const std::uint32_t slot : inputs.slots) {
    const bool is_new = state.last_frame[slot] + 1 != state.frames;
    const bool is_scheduled = is_pending && (same_time || slice_of(slot) == slice);
    if (changed_[slot] != 0 || is_new || is_scheduled) slots_due_.push_back(slot);
    state.last_frame[slot] = state.frames;
  }
  if (same_time) state.scheduler.complete();
  state.scheduler.complete_slice();

  // What the next frame compares with.
  state.last = {inputs.volume->id(), inputs.volume->revision(), inputs.volume->layout(), inputs.look,
                inputs.time};
  state.motions.assign(inputs.motions.begin(), inputs.motions.end());
  state.impulses.assign(inputs.impulses.begin(), inputs.impulses.end());
  return slots_due_;
}

}  // namespace brume::planning
