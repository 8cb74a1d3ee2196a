#include "render/scene_view.hpp"

#include "planning/device_lights.hpp"

namespace brume::render {
namespace {

/// Grenades in the air, and the objects that move.
std::vector<passes::Draw> moving_draws(const passes::SceneResources& scene,
                                       const planning::LevelState& level) {
  std::vector<passes::Draw> draws(level.grenades.size(), scene.grenade);
  for (std::size_t i = 0; i < draws.size(); ++i) draws[i].world_from_mesh = level.grenades[i];
  for (const scenario::MovedObject& moved : level.moved)
    for (passes::Draw draw : scene.draws) {
      if (draw.object != moved.object) continue;
      draw.world_from_mesh = moved.world_from_mesh;
      draws.push_back(draw);
    }
  return draws;
}

passes::PanePass::Needs pane_needs(const planning::FramePlan& plan) {
  return {planning::has_voxel_shadows(plan.lights), plan.media.casters};
}

}  // namespace

SceneView::SceneView(gpu::Context& context, gpu::CommandStream& stream, const scene::Scene& scene)
    : context_(context),
      stream_(stream),
      source_(&scene),
      scene_(passes::upload_scene(context, stream, scene)),
      gbuffer_pass_(context),
      shadow_pass_(context),
      shadows_(shadow_pass_.make_maps(context, scene_)),
      solid_(context),
      sky_light_(context),
      indirect_light_(context) {
  shadow_pass_.record(context, stream, scene_, {}, shadows_);
  if (scene_.has_panes) pane_pass_.emplace(context);
}

void SceneView::reserve(const planning::FramePlan& plan) {
  const planning::LevelState& level = plan.input.level;
  solid_.reserve(level.voxels);
  sky_light_.reserve(solid_);
  reserve_indirect_light(plan);
  if (pane_pass_) pane_pass_->reserve(pane_needs(plan));
  if (!plan.changed_objects.empty())
    shadow_pass_.record_changed(context_, stream_, scene_, level.hidden_objects, plan.changed_objects,
                                shadows_);
}

void SceneView::reserve_indirect_light(const planning::FramePlan& plan) {
  const planning::IndirectLightPlan& indirect = plan.indirect_light;
  if (indirect.bounces == 0) return;
  if (indirect.level_changed) {
    const reference::Surfaces surfaces(*source_, {&plan.input.level, 1});
    light_cells_ = reference::make_light_cells(*plan.input.level.voxels.light_grid(), surfaces);
  }
  indirect_light_.reserve(light_cells_, scene_.light_list.size() + planning::kMaxFlashes, plan.media.casters);
}

shared::IndirectLayout SceneView::indirect_layout(const planning::FramePlan& plan) const {
  shared::IndirectLayout layout = light_cells_.layout;
  layout.bounces = plan.indirect_light.bounces;
  return layout;
}

void SceneView::record_indirect_light(gpu::Recorder& recorder, const planning::FramePlan& plan,
                                      const gpu::Buffer& frame, const MediaResources& media) {
  const planning::IndirectLightPlan& indirect = plan.indirect_light;
  passes::IndirectLightPass::Inputs in{.frame = frame,
                                       .shadows = shadows_,
                                       .solid = solid_,
                                       .smoke = media.smoke,
                                       .hole_cells = media.hole_cells,
                                       .noise = media.noise,
                                       .volumes = media.volumes,
                                       .casters = plan.media.casters,
                                       .glow_field = media.glow_field};
  if (plan.input.smoke.volume && plan.input.smoke.volume->slot_count() > 0)
    in.g = shared::mean_cosine(plan.input.smoke.look.phase);
  else if (!plan.media.volumes.empty())
    in.g = plan.media.volumes.front().instance.look.anisotropy;
  if (indirect.level_changed) indirect_light_.upload(recorder, light_cells_);
  const shared::IndirectLayout& layout = light_cells_.layout;
  Box<int> cells{glm::ivec3(0), glm::ivec3(0)};
  if (!indirect.media.empty())
    cells =
        intersection(Box<int>{glm::ivec3(0), layout.size},
                     {glm::ivec3(glm::floor((indirect.media.low - layout.origin_world) / layout.cell_size)),
                      glm::ivec3(glm::ceil((indirect.media.high - layout.origin_world) / layout.cell_size))});
  indirect_light_.record(recorder, in, indirect, cells);
}

void SceneView::record_lights(gpu::Recorder& recorder, const planning::FramePlan& plan) const {
  recorder.upload(scene_.lights, 0, std::as_bytes(std::span(plan.lights)));
}

void SceneView::record_level(gpu::Recorder& recorder, const planning::FramePlan& plan,
                             const gpu::Buffer& frame) {
  if (solid_.record(recorder, plan.input.level.voxels)) sky_light_.record(recorder, frame, solid_);
}

void SceneView::record_gbuffer(gpu::Recorder& recorder, const planning::FramePlan& plan,
                               const gpu::Buffer& frame, const passes::GBuffer& target) const {
  const planning::LevelState& level = plan.input.level;
  gbuffer_pass_.record(recorder, scene_, moving_draws(scene_, level), level.hidden_objects, plan.frustum,
                       frame, target);
}

void SceneView::record_panes(gpu::Recorder& recorder, const planning::FramePlan& plan,
                             const passes::PanePass::Inputs& in, const gpu::Image& radiance) const {
  const planning::LevelState& level = plan.input.level;
  const std::vector<passes::Draw> moving = moving_draws(scene_, level);
  pane_pass_->record(
      recorder, pane_needs(plan), in,
      {scene_, moving, level.hidden_objects, plan.frustum, glm::normalize(plan.camera.forward)}, radiance);
}

}  // namespace brume::render
