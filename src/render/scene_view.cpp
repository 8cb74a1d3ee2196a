#include "render/scene_view.hpp"

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

}  // namespace

SceneView::SceneView(gpu::Context& context, gpu::CommandRunner& runner, const scene::Scene& scene)
    : context_(context),
      runner_(runner),
      scene_(passes::upload_scene(context, runner, scene)),
      gbuffer_pass_(context),
      shadow_pass_(context),
      shadows_(shadow_pass_.make_maps(context, scene_)),
      solid_(context),
      sky_light_(context) {
  shadow_pass_.record(context, runner, scene_, {}, shadows_);
}

void SceneView::reserve(const planning::FramePlan& plan) {
  const planning::LevelState& level = plan.input.level;
  solid_.reserve(level.voxels);
  sky_light_.reserve(solid_);
  if (!plan.changed_objects.empty())
    shadow_pass_.record_changed(context_, runner_, scene_, level.hidden_objects, plan.changed_objects,
                                shadows_);
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

}  // namespace brume::render
