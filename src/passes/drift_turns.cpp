#include "passes/drift_turns.hpp"

#include <algorithm>
#include <cstring>

#include "passes/light_reach.hpp"

namespace brume::passes {

bool DriftTurns::all_are_due(const DriftMoment& moment) const {
  if (!last_ || last_->volume != moment.volume) return true;
  const shared::SmokeVolumeFrame& frame = moment.volume->frame();
  if (frame.origin_world != last_->frame.origin_world || frame.voxel_size != last_->frame.voxel_size ||
      frame.atlas_bricks != last_->frame.atlas_bricks ||
      std::memcmp(&moment.look, &last_->look, sizeof moment.look) != 0)
    return true;
  // What is dirty is only that since the revision before.
  if (moment.volume->revision() != last_->revision && moment.volume->revision() != last_->revision + 1)
    return true;
  // A front that moves carries the noise with it.
  return !std::equal(motions_.begin(), motions_.end(), moment.motions.begin(), moment.motions.end(),
                     [](const auto& a, const auto& b) { return a.front == b.front; });
}

/// Marks the bricks that pushes come near.
void DriftTurns::mark_moved(const DriftMoment& moment, std::span<const shared::Push> pushes) {
  const shared::SmokeVolumeFrame& frame = moment.volume->frame();
  const float edge = frame.voxel_size * float{shared::kBrickVoxels};
  for (const shared::Push& push : pushes) {
    const float reach = push.radius + frame.voxel_size;  // a brick has one texel around it
    for (const std::uint32_t slot : moment.slots) {
      const glm::vec3 low = frame.origin_world + edge * glm::vec3(moment.volume->brick_of(slot));
      if (meets_box(push.from_world, push.to_world, low - reach, low + edge + reach)) moved_[slot] = 1;
    }
  }
}

void DriftTurns::remember(const DriftMoment& moment) {
  last_ = {moment.volume, moment.volume->revision(), moment.volume->frame(), moment.look, moment.time};
  motions_.assign(moment.motions.begin(), moment.motions.end());
  pushes_.assign(moment.pushes.begin(), moment.pushes.end());
}

std::span<const std::uint32_t> DriftTurns::due(const DriftMoment& moment) {
  ++frames_;
  const bool all = all_are_due(moment);
  if (all) left_ = 0;
  const bool stands = !all && moment.time == last_->time;
  if (!all && !stands) left_ = kTurns;
  moved_.assign(moment.volume->slot_count(), all ? 1 : 0);
  if (all) {
    seen_.clear();
  } else {
    const bool same_pushes =
        std::equal(pushes_.begin(), pushes_.end(), moment.pushes.begin(), moment.pushes.end(),
                   [](const auto& a, const auto& b) { return std::memcmp(&a, &b, sizeof a) == 0; });
    if (!same_pushes) mark_moved(moment, pushes_);
    if (!same_pushes) mark_moved(moment, moment.pushes);
    if (moment.volume->revision() != last_->revision) {
      for (const std::uint32_t slot : moment.volume->dirty_slots()) moved_[slot] = 1;
      for (const std::uint32_t slot : moment.volume->dirty_cell_slots()) moved_[slot] = 1;
    }
  }
  seen_.resize(moment.volume->slot_count());
  due_.clear();
  for (const std::uint32_t slot : moment.slots) {
    const bool is_new = seen_[slot] + 1 != frames_;
    const bool has_turn = left_ > 0 && (stands || slot % kTurns == frames_ % kTurns);
    if (moved_[slot] != 0 || is_new || has_turn) due_.push_back(slot);
    seen_[slot] = frames_;
  }
  left_ = stands ? 0 : left_ - (left_ > 0);
  remember(moment);
  return due_;
}

}  // namespace brume::passes
