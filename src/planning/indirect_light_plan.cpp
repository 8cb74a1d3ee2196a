#include "planning/indirect_light_plan.hpp"

#include "planning/key_bytes.hpp"
#include "planning/volume_light_plan.hpp"

namespace brume::planning {
namespace {

std::vector<std::byte> key_of(const FrameInput& input, const MediaPlan& media,
                              std::span<const shared::Light> lights) {
  KeyBytes key;
  key.add(input.environment.bounces);
  key.add(input.environment.sky.ambient);
  for (const shared::Light& light : lights) key.add(light);
  if (const smoke::SmokeVolume* smoke = input.smoke.volume; smoke && smoke->slot_count() > 0) {
    key.add(smoke->volume().id());
    key.add(smoke->revision());
    key.add(input.smoke.look.albedo);
    key.add(input.smoke.look.extinction);
    key.add(input.smoke.look.erosion);
    key.add(input.smoke.look.multiple_scattering);
    key.add(input.smoke.look.phase);
  }
  add_volumes(key, media, input.volumes);
  return key.take();
}

}  // namespace

IndirectLightPlan IndirectLightCache::plan(const FrameInput& input, const MediaPlan& media,
                                           std::vector<shared::Light> lights) {
  IndirectLightPlan plan;
  if (!input.level.voxels.grid || input.environment.bounces == 0) return plan;
  plan.bounces = input.environment.bounces;
  plan.lights = std::move(lights);
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
  std::vector<std::byte> key = key_of(input, media, plan.lights);
  plan.update = plan.level_changed || key != key_ || input.quality.rebuild_light;
  key_ = std::move(key);
  return plan;
}

}  // namespace brume::planning
