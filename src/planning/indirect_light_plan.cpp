#include "planning/indirect_light_plan.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "planning/key_bytes.hpp"
#include "planning/volume_light_plan.hpp"

namespace brume::planning {
namespace {

FrameVector<std::byte> key_of(const FrameInput& input, std::uint32_t bounces, const MediaPlan& media,
                              const HolePlan& holes, std::span<const shared::Light> lights,
                              Allocator memory) {
  KeyBytes key(memory);
  key.add(bounces);
  key.add(input.environment.sky.ambient);
  for (const shared::Light& light : lights) key.add(light);
  if (const smoke::SmokeVolume* smoke = input.smoke.volume; smoke && smoke->slot_count() > 0) {
    key.add(smoke->volume().id());
    key.add(smoke->revision());
    key.add(input.smoke.look.albedo);
    key.add(input.smoke.look.extinction);
    key.add(input.smoke.look.erosion);
    key.add(input.smoke.look.detail);
    key.add(input.smoke.look.multiple_scattering);
    key.add(input.smoke.look.phase);
    for (const shared::Hole& hole : holes.holes) key.add(hole);
    if (!holes.holes.empty()) key.add(holes.time);  // they open and close
  }
  add_volumes(key, media, input.volumes);
  return key.take();
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
  if (const smoke::SmokeVolume* smoke = input.smoke.volume; smoke && smoke->slot_count() > 0) {
    const shared::VolumeLayout& layout = smoke->layout();
    plan.media = {layout.origin_world + layout.bounds_min * layout.voxel_size,
                  layout.origin_world + layout.bounds_max * layout.voxel_size};
  }
  for (const PlacedVolume& volume : media.volumes) plan.media = united(plan.media, volume.bounds_world);
  plan.level_changed =
      !has_level_ || !(input.level.voxels == level_) || input.level.hidden_objects != hidden_objects_;
  level_ = input.level.voxels;
  hidden_objects_ = input.level.hidden_objects;
  has_level_ = true;
  if (plan.level_changed) shown_key_.clear();

  // What is being found goes on, unless it must be there at once or the number of its bounces changed.
  const FrameVector<std::byte> key = key_of(input, bounces, media, holes, lights, memory);
  const float fraction =
      std::min(input.quality.light_update_fraction, input.quality.indirect_update_fraction);
  const bool at_once = shown_key_.empty() || fraction >= 1;
  const bool changed = key != shown_key_ || input.quality.rebuild_light;
  if (changed && (solving_key_.empty() || at_once || plan.bounces != bounces_)) {
    solving_key_ = key;
    next_slice_ = 0;
  } else if (!changed && at_once) {
    solving_key_.clear();
  }
  bounces_ = plan.bounces;
  if (!solving_key_.empty()) plan.slices = next_slices(at_once ? 1 : fraction);
  plan.version = version_;
  return plan;
}

volume::IndexRange IndirectLightCache::next_slices(float fraction) {
  const std::uint32_t all = bounces_ * kSlicesPerBounce;
  const auto due = static_cast<std::uint32_t>(std::ceil(fraction * static_cast<float>(all)));
  const volume::IndexRange slices{next_slice_, std::min(due, all - next_slice_)};
  next_slice_ += slices.count;
  if (next_slice_ == all) {
    std::swap(shown_key_, solving_key_);
    solving_key_.clear();
    ++version_;
  }
  return slices;
}

}  // namespace brume::planning
