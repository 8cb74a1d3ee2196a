#include "render/parts/level.hpp"

#include <algorithm>
#include <iterator>

#include "planning/device_lights.hpp"

namespace brume::render {
namespace {

/// Grenades in the air, and the objects that move.
std::vector<passes::Draw> moving_draws(const passes::SceneResources& scene,
                                       const planning::LevelState& level) {
  std::vector<passes::Draw> draws(level.grenades.size(), scene.grenade);
  for (std::size_t i = 0; i < draws.size(); ++i) draws[i].world_from_mesh = level.grenades[i];
  for (const scene::MovedObject& moved : level.moved)
    for (passes::Draw draw : scene.draws) {
      if (draw.object != moved.object) continue;
      draw.world_from_mesh = moved.world_from_mesh;
      draws.push_back(draw);
    }
  return draws;
}

passes::PanePass::Needs pane_needs(const FramePlan& plan, bool has_tanks) {
  return {planning::has_voxel_shadows(plan.lights), plan.media.casters, has_tanks};
}

}  // namespace

LevelPart::LevelPart(gpu::Context& context, gpu::CommandStream& stream, const scene::Scene& scene,
                     Surfaces surfaces)
    : context_(context),
      stream_(stream),
      scene_(passes::upload_scene(context, stream, scene)),
      shadow_pass_(context),
      shadows_(shadow_pass_.make_maps(context, scene_)),
      solid_(context),
      sky_light_(context),
      indirect_light_(context),
      light_cells_maker_(scene) {
  if (surfaces == Surfaces::of_scene) gbuffer_pass_.emplace(context);
  shadow_pass_.record(context, stream, scene_, {}, shadows_);
  if (scene_.has_panes) pane_pass_.emplace(context);
}

void LevelPart::set_lights(const std::vector<scene::Light>& lights) {
  passes::upload_lights(context_, stream_, lights, scene_);
  forget_shadows();
}

void LevelPart::set_scene(const scene::Scene& scene) {
  light_cells_maker_.invalidate();
  scene_ = passes::upload_scene(context_, stream_, scene);
  if (scene_.has_panes && !pane_pass_) pane_pass_.emplace(context_);
  forget_shadows();
}

void LevelPart::forget_shadows() {
  shadows_ = shadow_pass_.make_maps(context_, scene_);
  without_shadow_.reset();
}

void LevelPart::prepare() {
  for (const std::uint32_t casters : {0u, shared::kMediumSmoke}) indirect_light_.reserve_pipelines(casters);
}

void LevelPart::reserve(const FramePlan& plan) {
  const planning::LevelState& level = plan.input.level;
  solid_.reserve(level.voxels);
  sky_light_.reserve(solid_);
  reserve_indirect_light(plan);
  if (pane_pass_) pane_pass_->reserve(pane_needs(plan, false));
  if (pane_pass_ && !plan.input.tanks.empty()) pane_pass_->reserve(pane_needs(plan, true));
  redraw_shadows(level.hidden_objects);
}

/// The maps are drawn at once, whatever becomes of the frame.
void LevelPart::redraw_shadows(const std::vector<std::uint32_t>& hidden_objects) {
  if (without_shadow_ == hidden_objects) return;
  const std::optional<std::vector<std::uint32_t>> before = std::exchange(without_shadow_, std::nullopt);
  if (before) {
    std::vector<std::uint32_t> changed;
    std::ranges::set_symmetric_difference(*before, hidden_objects, std::back_inserter(changed));
    shadow_pass_.record_changed(context_, stream_, scene_, hidden_objects, changed, shadows_);
  } else {
    shadow_pass_.record(context_, stream_, scene_, hidden_objects, shadows_);
  }
  without_shadow_ = hidden_objects;
}

void LevelPart::reserve_indirect_light(const FramePlan& plan) {
  const planning::IndirectLightPlan& indirect = plan.indirect_light;
  if (indirect.bounces == 0) return;
  if (indirect.level_changed) {
    ++levels_;
    light_cells_ = light_cells_maker_.make(plan.input.level);
  } else if (plan.input.view.sample.index ==
             0) {  // a frame that follows another: the next level may come, too
    light_cells_maker_.expect(plan.input.level.next);
  }
  indirect_light_.reserve(light_cells_, scene_.light_list.size() + planning::kMaxFlashes, plan.media.casters);
}

shared::IndirectLayout LevelPart::indirect_layout(const FramePlan& plan) const {
  shared::IndirectLayout layout = light_cells_.layout;
  layout.bounces = plan.indirect_light.bounces;
  return layout;
}

void LevelPart::record_indirect_light(gpu::Recorder& recorder, const FramePlan& plan,
                                      const FrameResources& resources) {
  const planning::IndirectLightPlan& indirect = plan.indirect_light;
  if (indirect.slices.count == 0) return;
  const gpu::Scope timed(recorder, "indirect_light");
  passes::IndirectLightPass::Inputs in{.frame = resources.frame,
                                       .shadows = shadows_,
                                       .solid = solid_,
                                       .media = resources.lit_media,
                                       .noise = resources.noise,
                                       .g = plan.media.mean_cosine,
                                       .glow_field = resources.glow_field};
  if (indirect.level_changed) {
    indirect_light_.upload(recorder, light_cells_);
    recorder.change(uploaded_levels_) = levels_;
  }

  // The cells that media touch.
  const shared::IndirectLayout& layout = light_cells_.layout;
  Box<int> cells{glm::ivec3(0), glm::ivec3(0)};
  if (!indirect.media.empty())
    cells =
        intersection(Box<int>{glm::ivec3(0), layout.size},
                     {glm::ivec3(glm::floor((indirect.media.low - layout.origin_world) / layout.cell_size)),
                      glm::ivec3(glm::ceil((indirect.media.high - layout.origin_world) / layout.cell_size))});
  indirect_light_.record(recorder, in, indirect, cells);
}

void LevelPart::upload(gpu::Recorder& recorder, const FramePlan& plan) const {
  recorder.upload(scene_.lights, 0, std::as_bytes(std::span(plan.lights)));
}

void LevelPart::record_light(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  if (solid_.record(recorder, plan.input.level.voxels)) sky_light_.record(recorder, in.frame, solid_);
}

void LevelPart::record_gbuffer(gpu::Recorder& recorder, const FramePlan& plan,
                               const FrameResources& in) const {
  const planning::LevelState& level = plan.input.level;
  gbuffer_pass_->record(recorder, scene_, moving_draws(scene_, level), level.hidden_objects, plan.frustum,
                        in.frame, in.targets.gbuffer);
}

void LevelPart::record_panes(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                             const gpu::Image& media, const gpu::Image& layers) const {
  if (!scene_.has_panes) return;
  const gpu::Scope timed(recorder, "panes");
  const planning::LevelState& level = plan.input.level;
  const std::vector<passes::Draw> moving = moving_draws(scene_, level);
  std::optional<passes::PanePass::Tanks> tanks;
  if (&layers != &media) tanks.emplace(passes::PanePass::Tanks{layers, in.surfaces});
  pane_pass_->record(
      recorder, pane_needs(plan, tanks.has_value()),
      {in.frame, in.shadows, in.smoke_shadows, in.level, in.targets.gbuffer.depth, media, in.lit_media,
       tanks},
      {scene_, moving, level.hidden_objects, plan.frustum, glm::normalize(plan.camera.forward)},
      in.targets.radiance);
}

}  // namespace brume::render
