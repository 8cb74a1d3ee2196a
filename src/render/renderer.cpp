#include "render/renderer.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <iterator>

#include "passes/blue_noise.hpp"
#include "render/device_camera.hpp"

namespace brume::render {
namespace {

// The share of light up to which shadows of smoke and its noise take turns, too.
constexpr float kSlicedUpdatesBelow = 0.25f;
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

const sim::State& state_of(const FrameInput& input) {
  static const sim::State kNothing;
  return input.state ? *input.state : kNothing;
}

passes::DebugSubject subject_of(const FrameInput& input) {
  const passes::ViewSlice slice = input.view_slice.value_or(
      passes::slice_through_smoke(input.volume, input.camera.position_world, input.camera.target_world));
  return {input.view, slice, input.level, input.volume, input.state};
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
  blocks_.reset();
  if (scale > 1) blocks_.emplace(context_, size_px_, scale);
}

void Renderer::resize(glm::uvec2 size_px) {
  size_px_ = size_px;
  gbuffer_ = passes::GBuffer(context_, size_px_);
  smoke_shadows_ =
      smoke_shadow_pass_.make_shadows(context_, size_px_, scene_.light_list.size() + passes::kMaxFlashes);
  smoke_shadow_plan_ = {};
  smoke_image_ = storage_image(context_, size_px_, VK_FORMAT_R16G16B16A16_SFLOAT);
  picture_ = storage_image(context_, size_px_, VK_FORMAT_R16G16B16A16_SFLOAT);
  display_image_ = storage_image(context_, size_px_, VK_FORMAT_R8G8B8A8_UNORM);
  if (accumulate_pass_) accumulate_pass_.emplace(context_, size_px_);
  set_march_scale(march_scale_);
  smoke_changed_ = true;  // other smoke may be in view
}

void Renderer::set_masks(const smoke::MaskAtlas& masks) {
  hole_clusters_.set_masks(context_, runner_, masks);
}

void Renderer::find_visibility(const FrameInput& input) {
  const planning::ViewFrustum view(device_camera(input.camera, size_px_));
  std::vector<shared::Light> lights = scene_.light_list;
  const std::size_t flashes = std::min(input.flashes.size(), passes::kMaxFlashes);
  lights.insert(lights.end(), input.flashes.begin(),
                input.flashes.begin() + static_cast<std::ptrdiff_t>(flashes));
  const float voxel_size = input.volume ? input.volume->layout().voxel_size : 0;
  lights_ = planning::visible_lights(lights, view, planning::light_interpolation_margin(voxel_size));
  visibility_ = {};
  if (input.volume)
    visibility_ = planning::cull_smoke(*input.volume, view, lights_, {scene_.bounds_min, scene_.bounds_max});
}

void Renderer::prepare(const FrameInput& input) {
  find_visibility(input);
  const std::uint32_t slots = input.volume ? input.volume->slot_count() : 0;
  if (input.volume) smoke_upload_.reserve(*input.volume);
  if (input.volume) noise_advection_pass_.reserve(state_of(input), *input.volume);
  const bool in_turns = input.volume && input.light_update_fraction <= kSlicedUpdatesBelow;
  noise_changed_ = in_turns && noise_advection_pass_.schedule(state_of(input), *input.volume, visibility_, input.look,
                                                   input.time, input.swirl_period);
  solid_.reserve(input.level);
  sky_light_.reserve(solid_);
  hole_clusters_.reserve(input.holes, input.time, input.look.hole_rim,
                      slots > 0 ? input.volume->layout() : shared::VolumeLayout(), slots, size_px_);
  const bool walls_changed = input.hidden_objects != hidden_objects_ || input.level.grid != lit_level_.grid ||
                             input.level.edits != lit_level_.edits;
  lit_level_ = input.level;
  if (input.hidden_objects != hidden_objects_) follow_hidden_objects(input);
  smoke_light_pass_.reserve({input.volume, &visibility_, lights_, input.holes, input.time, input.look, input.sky,
                             input.camera.position_world, walls_changed || input.rebuild_light,
                             input.light_update_fraction, noise_changed_});
  if (input.view != passes::DebugView::none) reserve_view(input);
}

void Renderer::reserve_view(const FrameInput& input) {
  if (!debug_view_) debug_view_.emplace(context_);
  debug_view_->reserve(subject_of(input), size_px_);
  if (input.view == passes::DebugView::steps && !counting_march_)
    counting_march_.emplace(context_, passes::MarchPass::Options{false, true, brute_force_holes_});
}

void Renderer::record_view(gpu::Recorder& recorder, const FrameInput& input) {
  debug_view_->record(recorder, subject_of(input),
                      {frame_, gbuffer_, smoke_upload_.resources(), hole_clusters_.resources()}, display_image_);
}

void Renderer::follow_hidden_objects(const FrameInput& input) {
  std::vector<std::uint32_t> changed;
  std::set_symmetric_difference(hidden_objects_.begin(), hidden_objects_.end(), input.hidden_objects.begin(),
                                input.hidden_objects.end(), std::back_inserter(changed));
  hidden_objects_ = input.hidden_objects;
  shadow_pass_.record_changed(context_, runner_, scene_, hidden_objects_, changed, shadows_);
  smoke_changed_ = true;  // the light in it has
}

void Renderer::record_frame_constants(gpu::Recorder& recorder, const FrameInput& input) {
  shared::FrameConstants frame{};
  frame.camera = device_camera(input.camera, size_px_);
  frame.sky = input.sky;
  frame.look = input.look;
  frame.look.step_length *= input.step_scale;
  if (input.volume && input.volume->slot_count() > 0) frame.volume = input.volume->layout();
  frame.volume.bounds_min = visibility_.visible_bounds.low;
  frame.volume.bounds_max = visibility_.visible_bounds.high;
  frame.caster_bounds_min = visibility_.bounds.low;
  frame.caster_bounds_max = visibility_.bounds.high;
  frame.solid = solid_.layout();
  frame.volume.voxel_size = std::max(frame.volume.voxel_size, 1e-6f);
  frame.size_px = size_px_;
  frame.light_count = static_cast<std::uint32_t>(lights_.size());
  frame.holes = hole_clusters_.layout();
  frame.frame_index = input.frame_index;
  frame.time = input.time;
  frame.exposure = input.exposure;
  frame.march_scale = march_scale_;
  frame.resolve_error = shared::kResolveError * input.resolve_error_scale;
  recorder.upload(frame_, 0, std::as_bytes(std::span(&frame, 1)));
  recorder.upload(scene_.lights, 0, std::as_bytes(std::span(lights_)));
  recorder.fill(march_of(input).counters, 0);
}

void Renderer::record_frame(gpu::Recorder& recorder, const FrameInput& input) {
  const auto stage = [&](const char* name, auto record) {
    const gpu::Scope scope(recorder, name);
    record();
  };
  const auto& smoke = smoke_upload_.resources();

  stage("upload", [&] {
    record_frame_constants(recorder, input);
    if (input.volume) smoke_changed_ = smoke_upload_.record(recorder, *input.volume) || smoke_changed_;
    smoke_upload_.record_visibility(recorder, visibility_);
  });
  stage("sky_light", [&] {
    if (solid_.record(recorder, input.level)) sky_light_.record(recorder, frame_, solid_);
  });
  stage("gbuffer", [&] {
    gbuffer_pass_.record(recorder, scene_, grenade_draws(scene_, input.grenades), input.hidden_objects,
                         planning::ViewFrustum(device_camera(input.camera, size_px_)), frame_, gbuffer_);
  });
  const auto& holes = hole_clusters_.resources();
  stage("holes", [&] { hole_clusters_.record(recorder, frame_, smoke); });
  stage("drift", [&] {
    if (input.volume)
      noise_advection_pass_.record(recorder, {frame_, smoke, noise_, state_of(input), input.time, input.swirl_period});
  });
  const bool light_smoke = input.volume && (needs_light(input) || noise_changed_);
  stage("smoke_shadow", [&] { record_smoke_shadows(recorder, input, light_smoke); });
  stage("smoke_light", [&] {
    smoke_light_pass_.record(recorder, {frame_, scene_, shadows_, smoke, holes, {solid_, sky_light_}});
  });
  const March march = march_of(input);
  stage("march", [&] { record_march(recorder, march); });
  if (blocks_) stage("resolve", [&] { record_resolve(recorder, march); });
  if (accumulate_pass_)
    stage("accumulate", [&] {
      accumulate_pass_->record(recorder, frame_, device_camera(input.camera, size_px_), gbuffer_.depth,
                               smoke_image_, input.continues);
    });
  if (input.view != passes::DebugView::none) {
    stage("debug_view", [&] { record_view(recorder, input); });
    return;
  }
  stage("shade", [&] {
    shade_pass_.record(recorder, frame_, scene_, shadows_, smoke_shadows_, {solid_, sky_light_}, gbuffer_,
                       this->smoke(), picture_);
  });
  stage("display", [&] { display_pass_.record(recorder, frame_, blue_noise_, picture_, display_image_); });
}

void Renderer::record_smoke_shadows(gpu::Recorder& recorder, const FrameInput& input, bool anew) {
  const auto boxes =
      input.volume ? planning::smoke_boxes(*input.volume, visibility_) : std::vector<planning::WorldBox>();
  auto plan = planning::plan_smoke_shadows(
      {lights_, shadows_.sun_clip_from_world, device_camera(input.camera, size_px_)}, boxes,
      glm::uvec2(smoke_shadows_.atlas.info().size));
  const bool same_plan = plan == smoke_shadow_plan_;
  smoke_shadow_plan_ = std::move(plan);
  // In four frames; texels of every frame lie beside each other.
  constexpr std::array<glm::uvec2, 4> kSlices{{{0, 0}, {1, 1}, {1, 0}, {0, 1}}};
  const bool in_turns = same_plan && input.light_update_fraction <= kSlicedUpdatesBelow;
  if (anew || !same_plan) smoke_shadow_turns_ = kSlices.size();
  if (smoke_shadow_turns_ == 0) return;
  passes::SmokeShadowPass::Texels texels;
  if (in_turns) texels = {2, kSlices[++smoke_shadow_turn_ % kSlices.size()]};
  smoke_shadow_turns_ = in_turns ? smoke_shadow_turns_ - 1 : 0;
  smoke_shadow_pass_.record(
      recorder, {frame_, scene_, shadows_, solid_, smoke_upload_.resources(), hole_clusters_.resources()},
      smoke_shadow_plan_, smoke_shadows_, texels);
}

passes::MarchPass::Inputs Renderer::march_inputs() const {
  return {frame_, smoke_upload_.resources(), noise_, gbuffer_.depth, blue_noise_, hole_clusters_.resources()};
}

Renderer::March Renderer::march_of(const FrameInput& input) const {
  if (input.view == passes::DebugView::steps) return {*counting_march_, debug_view_->counters()};
  return {march_pass_, counters_};
}

void Renderer::record_march(gpu::Recorder& recorder, const March& march) {
  if (!blocks_) {
    march.pass.record(recorder, march_inputs(), smoke_image_, march.counters);
    return;
  }
  resolve_pass_.record_ends(recorder, frame_, gbuffer_.depth, *blocks_);
  march.pass.record_tiles(recorder, march_inputs(), *blocks_, march.counters);
}

void Renderer::record_resolve(gpu::Recorder& recorder, const March& march) {
  resolve_pass_.record_select(recorder, frame_, gbuffer_.emission, *blocks_);
  resolve_pass_.record(recorder, frame_, gbuffer_.depth, *blocks_, smoke_image_);
  march.pass.record_list(recorder, march_inputs(), *blocks_, smoke_image_, march.counters);
}

bool Renderer::needs_light(const FrameInput& input) {
  const bool same_look = std::memcmp(&lit_look_, &input.look, sizeof lit_look_) == 0 &&
                         std::memcmp(&lit_sky_, &input.sky, sizeof lit_sky_) == 0;
  // Scattering depends on where the eye is, and only what may be in view is lit.
  const bool same_view = lit_camera_.position_world == input.camera.position_world &&
                         lit_camera_.target_world == input.camera.target_world &&
                         lit_camera_.vertical_fov == input.camera.vertical_fov;
  // Noise drifts, holes open and close.
  const bool has_holes = hole_clusters_.layout().count > 0;
  const bool same_moment = lit_time_ == input.time || (input.look.erosion == 0 && !has_holes && !lit_holes_);
  lit_holes_ = has_holes;
  const bool same_flashes =
      std::equal(lit_flashes_.begin(), lit_flashes_.end(), input.flashes.begin(), input.flashes.end(),
                 [](const auto& a, const auto& b) { return std::memcmp(&a, &b, sizeof a) == 0; });
  const bool needed =
      smoke_changed_ || !same_flashes || !same_look || !same_view || !same_moment || input.rebuild_light;
  lit_time_ = input.time;
  lit_camera_ = input.camera;
  lit_look_ = input.look;
  lit_sky_ = input.sky;
  lit_flashes_ = input.flashes;
  smoke_changed_ = false;
  return needed;
}

}  // namespace brume::render
