#include "planning/frame_plan.hpp"

#include <algorithm>
#include <array>

#include "planning/device_camera.hpp"
#include "shared/opaque.h"

namespace brume::planning {
namespace {

/// Finds which lights and which smoke are visible, and which smoke the device is to hold. Returns all lights.
FrameVector<shared::Light> plan_visibility(FramePlan& plan, const PlanTarget& target, PlanHistory& history) {
  const Allocator memory = history.memory.get();
  const smoke::SmokeVolume* volume = plan.input.smoke.volume;
  const Environment& environment = plan.input.environment;

  // The lights of the scene and of the frame, and which of them reach what is in view.
  FrameVector<shared::Light> lights(target.lights.begin(), target.lights.end(), memory);
  const std::size_t most = lights.size() + kMaxFlashes;
  for (const auto* more : {&environment.flashes, &environment.glow})
    for (const shared::Light& light : *more)
      if (lights.size() < most) lights.push_back(light);
  const float voxel_size = volume ? volume->layout().voxel_size : 0;
  plan.lights = visible_lights(lights, plan.frustum, light_interpolation_margin(voxel_size), memory);
  if (!volume) return lights;

  // The smoke: all of it is on the device, or what this frame needs. Indirect light comes from all of it.
  SmokeVisibility visible = cull_smoke(*volume, plan.frustum, plan.lights, target.scene_bounds, memory);
  if (target.holds_all_smoke) {
    plan.visibility = std::move(visible);
    plan.smoke = volume;
    return lights;
  }
  plan.visibility = history.resident->update({.volume = *volume,
                                              .all = plan.input.environment.bounces > 0,
                                              .eye_world = plan.input.view.camera.position_world,
                                              .atlas_bricks = target.room.atlas_bricks,
                                              .most_bricks = target.room.most_bricks},
                                             visible, memory);
  plan.smoke = history.resident.get();
  return lights;
}

void plan_hole_clusters(FramePlan& plan, Allocator memory) {
  const SmokeInput& smoke = plan.input.smoke;
  const std::uint32_t slots = plan.smoke ? plan.smoke->slot_count() : 0;
  plan.holes =
      plan_holes(smoke.holes, smoke.time, smoke.look.hole_rim,
                 slots > 0 ? plan.smoke->layout() : shared::VolumeLayout(), slots, plan.size_px, memory);
}

/// Sets the transmittances below which rays end or take longer steps: what is behind is too dark to be seen.
void limit_rays(FramePlan& plan, std::span<const Emitter> emitters) {
  const float brightest = brightest_behind(plan.input, plan.frustum, emitters, plan.media, plan.lights);
  shared::FrameMedia& media = plan.media.frame;
  media.opaque_transmittance =
      shared::opaque_below(media.opaque_transmittance, plan.input.view.exposure * brightest);
  media.coarse_transmittance = shared::coarse_below(media.opaque_transmittance);
}

/// Finds which media and decals are visible, at which resolution volumes are shown, and the indirect light.
void plan_visible_media(FramePlan& plan, const PlanTarget& target, PlanHistory& history,
                        std::span<const shared::Light> lights) {
  const Allocator memory = history.memory.get();

  // Previews take the place of volumes whose bricks are not on the device yet.
  plan.residency =
      history.volume_streaming.plan(plan.input.volumes, plan.frustum, plan.input.view.camera.position_world,
                                    plan.input.quality.volume_upload_bytes);
  std::array<bool, shared::kMaxVolumes> shown{}, lit{};  // plan_media throws where there are more
  for (std::size_t i = 0; i < std::min(plan.residency.size(), shown.size()); ++i) {
    shown[i] = plan.residency[i].shows_preview;
    lit[i] = plan.residency[i].lit_by_preview;
  }

  // As rays from the eye meet them.
  plan.media = plan_media(plan.input, plan.visibility, plan.frustum, plan.lights, shown, plan.smoke, memory);
  set_tables(plan.media, history.volume_tables.update(plan.input.volumes));
  limit_rays(plan, target.emitters);
  plan.decals = plan_decals(plan.input, plan.frustum, memory);

  // As light meets them.
  plan.lit_media.volumes.reserve(plan.media.volumes.size());
  plan.lit_media = plan.media;
  if (lit != shown) choose_previews(plan.lit_media, plan.input.volumes, lit);
  if (!target.room.holds_indirect_light) history.indirect_light.invalidate();
  plan.indirect_light = history.indirect_light.plan(plan.input, plan.lit_media, plan.holes, lights, memory);
}

void plan_past(FramePlan& plan, PlanHistory& history) {
  const View& view = plan.input.view;
  std::optional<PastView>& last = history.views.propose()[view.index];
  if (view.continues) plan.past = last;
  if (view.previous)
    plan.past = past_view(view.previous->camera, last ? last->size_px : plan.size_px, view.previous->sample,
                          view.projection);
  last = past_view(view.camera, plan.size_px, view.sample, view.projection);
}

void plan_level(FramePlan& plan, PlanHistory& history) {
  const LevelState& level = plan.input.level;
  PlanHistory::Level& next = history.level.propose();
  plan.level_changed = level.hidden_objects != next.hidden_objects || !(level.voxels == next.voxels);
  next.hidden_objects = level.hidden_objects;
  next.voxels = level.voxels;
}

void plan_noise_updates(FramePlan& plan, PlanHistory& history) {
  const SmokeInput& smoke = plan.input.smoke;
  if (!plan.smoke) return;
  plan.noise.motion = smoke::noise_motion(plan.state(), static_cast<double>(smoke.time), smoke.swirl_period,
                                          history.memory.get());
  InputKey motion(history.memory.get());
  add_motion(motion, plan.noise.motion);
  plan.noise.motion_changed = motion != history.noise_motion.now();
  history.noise_motion.propose() = motion;
  if (!history.noise.applies_to(plan.input.quality.light_update_fraction)) {
    plan.noise.catches_up = history.noise.is_late();
    history.noise.skip_frame();
    return;
  }
  const auto slots_due = history.noise.slots_due({plan.smoke, plan.visibility.slots, plan.noise.motion.clouds,
                                                  plan.noise.motion.impulses, smoke.look, smoke.time});
  plan.noise.slots_due.emplace(slots_due.begin(), slots_due.end(), history.memory.get());
  plan.noise.catches_up = !slots_due.empty();
}

void plan_smoke_shadow_update(FramePlan& plan, const PlanTarget& target, PlanHistory& history) {
  const SmokeInput& smoke = plan.input.smoke;
  const Quality& quality = plan.input.quality;
  const Allocator memory = history.memory.get();
  const FrameVector<Box<float>> boxes = caster_boxes(plan.media, plan.visibility, plan.smoke, memory);
  plan.smoke_shadows = history.smoke_shadows.update(
      plan_smoke_shadows(
          {plan.lights, target.sun_clip_from_world,
           device_camera(plan.input.view.camera, plan.size_px, {}, plan.input.view.projection)},
          boxes, target.smoke_shadow_atlas, memory),
      {plan.smoke, &plan.visibility, plan.lights, &plan.holes, &plan.noise, smoke.look, smoke.time,
       plan.level_changed || plan.volume_light.update || plan.volume_light.casters_changed ||
           quality.rebuild_light,
       quality.light_update_fraction},
      memory);
}

void plan_smoke_light(FramePlan& plan, const PlanTarget& target, PlanHistory& history) {
  const FrameInput& input = plan.input;
  plan.smoke_light = &history.smoke_light.plan(
      {plan.smoke, input.smoke.volume, &plan.visibility, plan.lights, input.smoke.holes, input.smoke.time,
       input.smoke.look, input.environment.sky, viewpoint(input.view),
       plan.level_changed || plan.volume_light.casters_changed || input.quality.rebuild_light ||
           (plan.smoke == history.resident.get() && history.resident->shows_other_smoke()),
       input.quality.light_update_fraction, plan.noise.catches_up || plan.noise.motion_changed,
       plan.indirect_light.version, target.room.smoke_light},
      history.memory.get());
}

void plan_volume_light(FramePlan& plan, const PlanTarget& target, PlanHistory& history) {
  const FrameInput& input = plan.input;
  plan.volume_light = history.volume_light.plan(
      {&plan.lit_media, input.volumes, plan.lights, plan.smoke, input.smoke.look, input.smoke.time,
       &plan.noise, &plan.holes, input.environment.sky, plan.level_changed || input.quality.rebuild_light,
       plan.indirect_light.version, target.room.volume_light},
      history.memory.get());
  for (std::size_t i = 0; i < plan.media.frame.volume_count; ++i) {
    const shared::VolumeSweep& sun = plan.volume_light.sweeps[i * shared::kSweepsOfVolume];
    for (MediaPlan* media : {&plan.media, &plan.lit_media}) {
      shared::VolumeInstance& volume = media->volumes[i].instance;
      volume.sun_from_voxel = shared::affine_of(glm::mat4x3(glm::mat4(matrix_of(sun.sweep_from_world)) *
                                                            glm::mat4(matrix_of(volume.world_from_voxel))));
    }
  }
}

}  // namespace

FramePlan::FramePlan(const FrameInput& frame_input, glm::uvec2 frame_size_px, Allocator memory)
    : input(frame_input),
      size_px(frame_size_px),
      camera(device_camera(frame_input.view.camera, frame_size_px, frame_input.view.sample,
                           frame_input.view.projection)),
      frustum(camera),
      lights(memory),
      visibility{.slots = FrameVector<std::uint32_t>(memory)},
      media{.volumes = FrameVector<PlacedVolume>(memory)},
      decals(memory),
      lit_media{.volumes = FrameVector<PlacedVolume>(memory)},
      holes{.holes = FrameVector<shared::Hole>(memory), .reaches = FrameVector<shared::HoleReach>(memory)},
      noise{.motion = {.clouds = FrameVector<shared::CloudMotion>(memory),
                       .impulses = FrameVector<shared::Impulse>(memory)}},
      fine_light{.slots = FrameVector<std::uint32_t>(memory), .pages = FrameVector<std::uint32_t>(memory)},
      volume_light{.sweeps = FrameVector<shared::VolumeSweep>(memory)},
      indirect_light{.lights = FrameVector<shared::Light>(memory)} {}

const sim::State& FramePlan::state() const {
  static const sim::State kNothing;
  return input.smoke.state ? *input.smoke.state : kNothing;
}

FramePlan plan_frame(const FrameInput& input, const PlanTarget& target, PlanHistory& history) {
  history.memory->reset();
  FramePlan plan(input, target.size_px, history.memory.get());
  plan.number = ++history.plans;
  plan_past(plan, history);
  const SmokeInput& smoke = plan.input.smoke;

  // What is visible.
  const FrameVector<shared::Light> lights = plan_visibility(plan, target, history);
  plan_hole_clusters(plan, history.memory.get());
  plan_visible_media(plan, target, history, lights);
  plan.particles = plan_particles(input.particles, target.slices, plan.frustum);

  // What changed, and what is updated: each step reads the plans of those before it.
  plan_level(plan, history);
  plan_noise_updates(plan, history);
  plan_volume_light(plan, target, history);
  plan_smoke_shadow_update(plan, target, history);
  plan_smoke_light(plan, target, history);
  if ((plan.media.media & shared::kMediumFineShadows) != 0)
    plan.fine_light = plan_fine_light(*plan.smoke, plan.visibility, plan.camera.eye_world,
                                      pixel_width(plan.camera, plan.size_px), history.memory.get());
  plan.view_slice = input.debug.slice.value_or(
      slice_through_smoke(smoke.volume, input.view.camera.position_world, input.view.camera.target_world));
  return plan;
}

void PlanHistory::commit() {
  noise.commit();
  noise_motion.commit();
  smoke_shadows.commit();
  smoke_light.commit();
  volume_light.commit();
  indirect_light.commit();
  volume_streaming.commit();
  level.commit();
  views.commit();
}

void PlanHistory::invalidate_light() {
  smoke_shadows.invalidate();
  smoke_light.invalidate();
  volume_light.invalidate();
  indirect_light.invalidate();
}

void PlanHistory::invalidate() {
  noise.invalidate();
  invalidate_light();
  volume_streaming = {};
  resident = std::make_unique<ResidentSmoke>();
  ++plans;  // earlier plans are no longer valid
}

}  // namespace brume::planning
