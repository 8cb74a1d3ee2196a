#include "render/renderer.hpp"

#include <algorithm>

#include "passes/blue_noise.hpp"

namespace brume::render {
namespace {

constexpr VkBufferUsageFlags kBufferUsage =
    VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT |
    VK_BUFFER_USAGE_TRANSFER_DST_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT;

gpu::Image storage_image(gpu::Context& context, glm::uvec2 size, VkFormat format) {
  gpu::ImageInfo info;
  info.format = format;
  info.size = {size, 1};
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  return gpu::Image(context, info);
}

std::vector<passes::Draw> grenade_draws(const passes::SceneResources& scene,
                                        const std::vector<glm::mat4>& grenades) {
  std::vector<passes::Draw> draws(grenades.size(), scene.grenade);
  for (std::size_t i = 0; i < draws.size(); ++i) draws[i].world_from_mesh = grenades[i];
  return draws;
}

passes::DebugSubject debug_subject(const FramePlan& plan) {
  const FrameInput& input = plan.input;
  return {input.debug.view, plan.view_slice, input.level.voxels, input.smoke.volume, input.smoke.state};
}

/// What every pass may read, but for the layouts of the renderer's own resources.
shared::FrameConstants frame_constants(const FramePlan& plan) {
  const FrameInput& input = plan.input;
  shared::FrameConstants frame{};
  frame.camera = plan.camera;
  frame.sky = input.environment.sky;
  frame.look = input.smoke.look;
  frame.look.step_length *= input.quality.step_scale;
  frame.volume = plan.media.smoke;
  frame.media = plan.media.frame;
  frame.caster_bounds_min = plan.visibility.caster_bounds.low;
  frame.caster_bounds_max = plan.visibility.caster_bounds.high;
  frame.size_px = plan.size_px;
  frame.light_count = static_cast<std::uint32_t>(plan.lights.size());
  frame.holes = plan.holes.layout();
  frame.frame_index = input.view.frame_index;
  frame.time = input.smoke.time;
  frame.exposure = input.view.exposure;
  frame.resolve_error = shared::kResolveError * input.quality.resolve_error_scale;
  return frame;
}

}  // namespace

Renderer::Renderer(gpu::Context& context, gpu::CommandRunner& runner, const scene::Scene& scene,
                   const RendererOptions& options)
    : context_(context),
      runner_(runner),
      size_px_(options.size_px),
      brute_force_holes_(options.brute_force_holes),
      scene_(passes::upload_scene(context, runner, scene)),
      gbuffer_pass_(context),
      shadow_pass_(context),
      smoke_shadow_pass_(context),
      shade_pass_(context),
      smoke_light_pass_(context),
      march_pass_(context, {options.count_samples, false, options.brute_force_holes}),
      resolve_pass_(context),
      display_pass_(context),
      smoke_upload_(context),
      volume_upload_(context),
      noise_advection_pass_(context),
      solid_(context),
      sky_light_(context),
      shadows_(shadow_pass_.make_maps(context, scene_)),
      gbuffer_(context, size_px_),
      smoke_shadows_(
          smoke_shadow_pass_.make_shadows(context, size_px_, scene_.light_list.size() + passes::kMaxFlashes)),
      noise_(passes::make_noise_tile(context, passes::kSmokeNoise.size)),
      smoke_image_(storage_image(context, size_px_, VK_FORMAT_R16G16B16A16_SFLOAT)),
      picture_(storage_image(context, size_px_, VK_FORMAT_R16G16B16A16_SFLOAT)),
      display_image_(storage_image(context, size_px_, VK_FORMAT_R8G8B8A8_UNORM)),
      hole_clusters_(context, runner, options.masks ? *options.masks : smoke::MaskAtlas()),
      frame_(context, sizeof(shared::FrameConstants), kBufferUsage),
      counters_(context, sizeof(std::uint32_t), kBufferUsage) {
  set_march_scale(options.march_scale);
  if (options.temporal) accumulate_pass_.emplace(context, size_px_);
  shadow_pass_.record(context, runner, scene_, {}, shadows_);
  const passes::NoisePass noise(context);
  runner.run([&](gpu::Recorder& recorder) {
    noise.record(recorder, noise_, passes::kSmokeNoise);
    blue_noise_ = passes::make_blue_noise(context, recorder);
  });
}

void Renderer::set_march_scale(std::uint32_t scale) {
  march_scale_ = scale;
  march_tiles_.reset();
  if (scale > 1) march_tiles_.emplace(context_, size_px_, scale);
}

void Renderer::resize(glm::uvec2 size_px) {
  size_px_ = size_px;
  gbuffer_ = passes::GBuffer(context_, size_px_);
  smoke_shadows_ =
      smoke_shadow_pass_.make_shadows(context_, size_px_, scene_.light_list.size() + passes::kMaxFlashes);
  history_.smoke_shadows.invalidate();
  smoke_image_ = storage_image(context_, size_px_, VK_FORMAT_R16G16B16A16_SFLOAT);
  picture_ = storage_image(context_, size_px_, VK_FORMAT_R16G16B16A16_SFLOAT);
  display_image_ = storage_image(context_, size_px_, VK_FORMAT_R8G8B8A8_UNORM);
  if (accumulate_pass_) accumulate_pass_.emplace(context_, size_px_);
  set_march_scale(march_scale_);
}

void Renderer::set_masks(const smoke::MaskAtlas& masks) {
  hole_clusters_.set_masks(context_, runner_, masks);
  history_.smoke_shadows.invalidate();
  history_.smoke_light.invalidate();
}

planning::PlanTarget Renderer::plan_target() const {
  return {scene_.light_list,
          {scene_.bounds_min, scene_.bounds_max},
          shadows_.sun_clip_from_world,
          size_px_,
          glm::uvec2(smoke_shadows_.atlas.info().size)};
}

FramePlan Renderer::plan(const FrameInput& input) {
  FramePlan plan = planning::plan_frame(input, plan_target(), history_);
  reserve(plan);
  return plan;
}

/// Makes room for a plan, in the order of the data.
void Renderer::reserve(FramePlan& plan) {
  const FrameInput& input = plan.input;
  if (input.smoke.volume) {
    smoke_upload_.reserve(*input.smoke.volume);
    noise_advection_pass_.reserve(plan.state(), *input.smoke.volume, plan.noise);
  }
  volume_upload_.reserve(input.volumes);
  march_pass_.reserve(plan.media.media);
  solid_.reserve(input.level.voxels);
  sky_light_.reserve(solid_);
  hole_clusters_.reserve(plan.holes);
  if (!plan.changed_objects.empty())
    shadow_pass_.record_changed(context_, runner_, scene_, input.level.hidden_objects, plan.changed_objects,
                                shadows_);
  while (!smoke_light_pass_.reserve(*plan.smoke_light)) planning::replan_smoke_light(plan, history_);
  if (input.debug.view != planning::DebugView::none) reserve_debug_view(plan);
}

void Renderer::reserve_debug_view(const FramePlan& plan) {
  if (!debug_view_) debug_view_.emplace(context_);
  debug_view_->reserve(debug_subject(plan), size_px_);
  if (plan.input.debug.view != planning::DebugView::steps) return;
  if (!counting_march_)
    counting_march_.emplace(context_, passes::MarchPass::Options{false, true, brute_force_holes_});
  counting_march_->reserve(plan.media.media);
}

void Renderer::draw(const FrameInput& input, const std::function<void(gpu::Recorder&)>& then) {
  const FramePlan plan = this->plan(input);
  runner_.run([&](gpu::Recorder& recorder) {
    record_frame(recorder, plan);
    if (then) then(recorder);
  });
}

void Renderer::record_frame(gpu::Recorder& recorder, const FramePlan& plan) {
  const auto scope = [&](const char* name, auto record) {
    const gpu::Scope timed(recorder, name);
    record();
  };
  const FrameInput& input = plan.input;
  const passes::SmokeResources& smoke = smoke_upload_.resources();
  const passes::HoleResources& holes = hole_clusters_.resources();
  const passes::LevelLight level{solid_, sky_light_};
  const March march = march_of(plan);

  scope("upload", [&] { record_upload(recorder, plan); });
  scope("sky_light", [&] {
    if (solid_.record(recorder, input.level.voxels)) sky_light_.record(recorder, frame_, solid_);
  });
  scope("gbuffer", [&] { record_gbuffer(recorder, plan); });
  scope("holes", [&] { hole_clusters_.record(recorder, plan.holes, frame_, smoke); });
  scope("noise_advection", [&] {
    if (input.smoke.volume) noise_advection_pass_.record(recorder, plan.noise, {frame_, smoke, noise_});
  });
  scope("smoke_shadow", [&] { record_smoke_shadows(recorder, plan); });
  scope("smoke_light", [&] {
    smoke_light_pass_.record(recorder, *plan.smoke_light, {frame_, scene_, shadows_, smoke, holes, level});
  });
  scope("march", [&] { record_march(recorder, march); });
  if (march_tiles_) scope("resolve", [&] { record_resolve(recorder, march); });
  if (accumulate_pass_)
    scope("accumulate", [&] {
      accumulate_pass_->record(recorder, frame_, plan.camera, gbuffer_.depth, smoke_image_,
                               input.view.continues);
    });
  if (input.debug.view != planning::DebugView::none)
    return scope("debug_view", [&] { record_debug_view(recorder, plan); });
  scope("shade", [&] {
    const bool voxel_shadows = std::ranges::any_of(plan.lights, [](const shared::Light& light) {
      return light.shadow_layer == shared::kShadowByVoxels;
    });
    shade_pass_.record(recorder, frame_, scene_, shadows_, smoke_shadows_, level, gbuffer_, this->smoke(),
                       picture_, voxel_shadows);
  });
  scope("display", [&] { display_pass_.record(recorder, frame_, blue_noise_, picture_, display_image_); });
}

void Renderer::record_upload(gpu::Recorder& recorder, const FramePlan& plan) {
  shared::FrameConstants frame = frame_constants(plan);
  frame.solid = solid_.layout();
  frame.march_scale = march_scale_;
  recorder.upload(frame_, 0, std::as_bytes(std::span(&frame, 1)));
  recorder.upload(scene_.lights, 0, std::as_bytes(std::span(plan.lights)));
  recorder.fill(march_of(plan).counters, 0);
  if (plan.input.smoke.volume) smoke_upload_.record(recorder, *plan.input.smoke.volume);
  smoke_upload_.record_visibility(recorder, plan.visibility);
  volume_upload_.record(recorder, plan.input.volumes, plan.media.volumes);
}

void Renderer::record_gbuffer(gpu::Recorder& recorder, const FramePlan& plan) {
  const planning::LevelState& level = plan.input.level;
  gbuffer_pass_.record(recorder, scene_, grenade_draws(scene_, level.grenades), level.hidden_objects,
                       plan.frustum, frame_, gbuffer_);
}

void Renderer::record_smoke_shadows(gpu::Recorder& recorder, const FramePlan& plan) {
  if (!plan.smoke_shadows) return;
  smoke_shadow_pass_.record(
      recorder, {frame_, scene_, shadows_, solid_, smoke_upload_.resources(), hole_clusters_.resources()},
      *plan.smoke_shadows, smoke_shadows_);
}

passes::MarchPass::Inputs Renderer::march_inputs(std::uint32_t media) const {
  return {.frame = frame_,
          .media = media,
          .smoke = smoke_upload_.resources(),
          .volumes = volume_upload_.resources(),
          .noise = noise_,
          .depth = gbuffer_.depth,
          .blue_noise = blue_noise_,
          .holes = hole_clusters_.resources()};
}

Renderer::March Renderer::march_of(const FramePlan& plan) const {
  if (plan.input.debug.view == planning::DebugView::steps)
    return {*counting_march_, debug_view_->counters(), plan.media.media};
  return {march_pass_, counters_, plan.media.media};
}

void Renderer::record_march(gpu::Recorder& recorder, const March& march) {
  if (!march_tiles_) {
    march.pass.record(recorder, march_inputs(march.media), smoke_image_, march.counters);
    return;
  }
  resolve_pass_.record_ends(recorder, frame_, gbuffer_.depth, *march_tiles_);
  march.pass.record_tiles(recorder, march_inputs(march.media), *march_tiles_, march.counters);
}

void Renderer::record_resolve(gpu::Recorder& recorder, const March& march) {
  resolve_pass_.record_select(recorder, frame_, gbuffer_.emission, *march_tiles_);
  resolve_pass_.record(recorder, frame_, gbuffer_.depth, *march_tiles_, smoke_image_);
  march.pass.record_list(recorder, march_inputs(march.media), *march_tiles_, smoke_image_, march.counters);
}

void Renderer::record_debug_view(gpu::Recorder& recorder, const FramePlan& plan) {
  debug_view_->record(recorder, debug_subject(plan),
                      {frame_, gbuffer_, smoke_upload_.resources(), hole_clusters_.resources()},
                      display_image_);
}

}  // namespace brume::render
