#include "render/renderer.hpp"

#include <algorithm>
#include <cmath>

#include "passes/blue_noise.hpp"
#include "planning/device_camera.hpp"
#include "planning/device_lights.hpp"
#include "planning/lens.hpp"
#include "render/tank_layer.hpp"

namespace brume::render {
namespace {

/// Records the commands of a pass, measured under its name.
template <typename Record>
void scope(gpu::Recorder& recorder, const char* name, Record record) {
  const gpu::Scope timed(recorder, name);
  record();
}

passes::DebugSubject debug_subject(const FramePlan& plan) {
  const FrameInput& input = plan.input;
  return {input.debug.view, plan.view_slice, input.level.voxels, plan.smoke, input.smoke.state};
}

std::uint32_t bricks_of(glm::ivec3 atlas) {
  return static_cast<std::uint32_t>(atlas.x * atlas.y * atlas.z);
}

/// Each of n samples of a pixel stands for an nth of its area; a frame of an antialiased film for an eighth.
float texture_bias(const planning::ViewSample& sample) {
  constexpr float kLeastBias = -4;
  const bool in_film = sample.count == 1 && sample.pixel != glm::vec2(0);
  const std::uint32_t samples = in_film ? planning::kFilmSamples : sample.count;
  return std::max(-0.5f * std::log2(static_cast<float>(samples)), kLeastBias);
}

/// `displays`: whether shading may display, too. Without a GPU a pass of its own costs next to nothing.
passes::ShadePass::Needs shade_needs(const FramePlan& plan, bool displays) {
  return {.voxel_shadows = planning::has_voxel_shadows(plan.lights),
          .decals = !plan.decals.empty(),
          .display = displays && plan.particles.empty() && plan.input.view.sample.count <= 1};
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
  frame.pixel_width = planning::pixel_width(plan.camera, plan.size_px);
  frame.exposure = input.view.exposure;
  frame.tone = static_cast<std::uint32_t>(input.view.tone);
  frame.texture_bias = texture_bias(input.view.sample);
  frame.resolve_error = shared::kResolveError * input.quality.resolve_error_scale;
  return frame;
}

}  // namespace

Renderer::Renderer(gpu::Context& context, gpu::CommandStream& stream, const scene::Scene& scene,
                   const RendererOptions& options)
    : context_(context),
      stream_(stream),
      scene_(context, stream, scene),
      targets_(options.media_alone ? Targets::of_media(context, options.size_px)
                                   : Targets(context, options.size_px)),
      smoke_(context, stream, scene_, options.size_px, options.smoke),
      smoke_budget_(options.smoke.reserved_bricks),
      memory_follows_view_(options.smoke.memory_follows_view),
      shading_displays_(context.info().kind != "cpu" && !options.antialias),
      frame_(context, sizeof(shared::FrameConstants),
             VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  if (options.media_alone)
    surface_import_.emplace(context);
  else
    shade_pass_.emplace(context);
  if (options.antialias) antialias_pass_.emplace(context, options.size_px);
  stream.run([&](gpu::Recorder& recorder) { blue_noise_ = passes::make_blue_noise(context, recorder); });
  if (options.smoke.prepare_all && shade_pass_)
    for (const bool voxel_shadows : {false, true})
      shade_pass_->reserve(
          {.voxel_shadows = voxel_shadows, .display = shading_displays_ && !scene_.has_panes()});
}

void Renderer::set_march_scale(std::uint32_t scale) {
  smoke_.set_march_scale(scale);
}

void Renderer::resize(glm::uvec2 size_px) {
  targets_ = surface_import_ ? Targets::of_media(context_, size_px) : Targets(context_, size_px);
  smoke_.resize(scene_, size_px);
  decal_pass_.reset();
  average_pass_.reset();
  if (antialias_pass_) antialias_pass_.emplace(context_, size_px);
  occlusion_ = nullptr;
  history_.smoke_shadows.invalidate();
}

void Renderer::set_masks(const smoke::MaskAtlas& masks) {
  smoke_.set_masks(masks);
  history_.smoke_shadows.invalidate();
  history_.smoke_light.invalidate();
}

planning::PlanTarget Renderer::plan_target() const {
  const passes::SceneResources& scene = scene_.resources();
  return {scene.light_list,
          {scene.bounds_min, scene.bounds_max},
          scene.emitters,
          scene_.shadows().sun_clip_from_world,
          targets_.size_px,
          glm::uvec2(smoke_.shadows().atlas.info().size),
          slices_ ? slices_->textures() : std::span<const shared::SliceTexture>(),
          smoke_budget_.atlas_bricks(),
          smoke_budget_.most_bricks(),
          holds_all_smoke()};
}

void Renderer::invalidate() {
  // The shadow maps are as the last frame left them.
  std::vector<std::uint32_t> hidden_objects = std::move(history_.hidden_objects);
  history_ = planning::PlanHistory();
  ++plan_number_;
  history_.hidden_objects = std::move(hidden_objects);
}

void Renderer::invalidate_level() {
  invalidate();
  scene_.invalidate_level();
}

FramePlan Renderer::plan(const FrameInput& input) {
  input_ = input;
  const std::uint32_t room = bricks_of(smoke_.atlas_bricks());
  const std::uint32_t wanted = holds_all_smoke() ? room : history_.resident->wanted_count();
  if (smoke_budget_.begin_frame(context_.memory(), room, wanted)) {
    smoke_.trim(smoke_budget_.atlas_bricks());
    invalidate();
  }
  while (true) {
    std::optional<gpu::Memory::Unlimited> reserve;
    if (smoke_budget_.is_reserve()) reserve.emplace(context_.memory());
    try {
      return try_plan();
    } catch (const Error& error) {
      const bool is_full = error.code() == ErrorCode::resource_limit;
      if (!is_full || !input.smoke.volume || !smoke_budget_.reduce(bricks_of(smoke_.atlas_bricks()))) throw;
    }
  }
}

FramePlan Renderer::try_plan() {
  hidden_objects_before_ = history_.hidden_objects;
  try {
    upload_volumes(input_);
    upload_slices(input_);
    FramePlan plan = planning::plan_frame(input_, plan_target(), history_);
    reserve(plan);
    plan.number = ++plan_number_;
    return plan;
  } catch (...) {
    // What the plan counts as updated is not.
    history_.hidden_objects = hidden_objects_before_;
    invalidate();
    throw;
  }
}

/// Makes room for the volumes of a frame, and uploads those that it must find whole.
void Renderer::upload_volumes(const FrameInput& input) {
  constexpr std::uint64_t kPartBytes = 64u << 20;
  const std::uint64_t budget = input.quality.volume_upload_bytes;
  planning::VolumeStreaming& streaming = history_.volume_streaming;
  for (const std::uint64_t missing : smoke_.reserve_volumes(input.volumes)) streaming.lose(missing);
  while (!streaming.is_ready(input.volumes, budget)) {
    const std::vector<planning::VolumeResidency> part =
        streaming.plan_part(input.volumes, budget, kPartBytes);
    stream_.run([&](gpu::Recorder& recorder) { smoke_.record_volume_part(recorder, input.volumes, part); });
  }
}

/// Uploads volumes that are sampled without a march where they are others than before.
void Renderer::upload_slices(const FrameInput& input) {
  if (input.slices == loaded_slices_ && slices_) return;
  std::vector<std::span<const grids::DenseGrid>> volumes;
  if (input.slices)
    for (const auto& volume : *input.slices) volumes.emplace_back(*volume);
  if (volumes.empty() && !slices_) return;
  slices_.emplace(passes::SliceTextures::create(context_, stream_, volumes).value_or_throw());
  loaded_slices_ = input.slices;
}

void Renderer::reserve_decals() {
  if (!decal_pass_) decal_pass_.emplace(context_, targets_.size_px);
  if (!surface_import_) return;
  if (!normal_pass_) normal_pass_.emplace(context_);
  if (!targets_.gbuffer.normal_metallic) targets_.gbuffer.add_imported_normals(context_);
}

/// Makes room for a plan.
void Renderer::reserve(FramePlan& plan) {
  scene_.reserve(plan);
  smoke_.reserve(plan, history_);
  if (!plan.decals.empty()) reserve_decals();
  if (surface_import_) return;
  if (!plan.particles.empty()) {
    if (!particle_pass_) particle_pass_.emplace(context_);
    particle_pass_->reserve(plan.particles, targets_.size_px,
                            plan.input.debug.view == planning::DebugView::overdraw);
  }
  if (plan.input.view.sample.count > 1 && !average_pass_) average_pass_.emplace(context_, targets_.size_px);
  if (plan.input.debug.view == planning::DebugView::none) {
    const passes::ShadePass::Needs needs = shade_needs(plan, shading_displays_ && !scene_.has_panes());
    shade_pass_->reserve(needs);
    if (!needs.display && !display_pass_) display_pass_.emplace(context_);
    return;
  }
  if (!debug_view_) debug_view_.emplace(context_);
  debug_view_->reserve(debug_subject(plan), targets_.size_px);
}

void Renderer::draw(const FrameInput& input, const std::function<void(gpu::Recorder&)>& then) {
  const FramePlan plan = this->plan(input);
  stream_.run([&](gpu::Recorder& recorder) {
    record_frame(recorder, plan);
    if (then) then(recorder);
  });
}

FrameResources Renderer::resources(const FramePlan& plan) {
  BRUME_ASSERT(plan.number == plan_number_, "a plan that another one or invalidate() has replaced");
  const bool counts_steps = plan.input.debug.view == planning::DebugView::steps;
  return {frame_, scene_, targets_, blue_noise_, counts_steps ? &debug_view_->counters() : nullptr};
}

void Renderer::record_frame(gpu::Recorder& recorder, const FramePlan& plan) {
  for (int part = 0; part < kParts; ++part) record_part(recorder, plan, part);
}

void Renderer::record_part(gpu::Recorder& recorder, const FramePlan& plan, int part) {
  const FrameResources in = resources(plan);
  if (part == 0) record_light(recorder, plan, in, nullptr);
  if (part == 1) record_media(recorder, plan, in);
  if (part == 2) record_image(recorder, plan, in);
}

void Renderer::record_sweeps(gpu::Recorder& recorder, const FramePlan& plan) {
  const FrameResources in = resources(plan);
  record_until_sweeps(recorder, plan, in, nullptr);
  scope(recorder, "sweeps", [&] { smoke_.record_volume_sweeps(recorder, plan, in); });
}

void Renderer::record_rays(gpu::Recorder& recorder, const FramePlan& plan) {
  const FrameResources in = resources(plan);
  scope(recorder, "volume_light", [&] { smoke_.record_volume_light(recorder, plan, in); });
  record_media(recorder, plan, in);
}

void Renderer::record_picture(gpu::Recorder& recorder, const FramePlan& plan) {
  record_image(recorder, plan, resources(plan));
}

void Renderer::record_media_over(gpu::Recorder& recorder, const FramePlan& plan,
                                 const HostSurfaces& surfaces) {
  const FrameResources in = resources(plan);
  record_light(recorder, plan, in, &surfaces);
  record_media(recorder, plan, in);
  record_accumulate(recorder, plan, in);
}

void Renderer::record_surfaces(gpu::Recorder& recorder, const FramePlan& plan, const HostSurfaces* host) {
  if (!host) return scene_.record_gbuffer(recorder, plan, frame_, targets_.gbuffer);
  surface_import_->record(recorder, host->depth, host->range, plan.camera.near_z, targets_.gbuffer);
}

/// What later frames rely on, too: everything that the plan's history counts as updated.
void Renderer::record_light(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                            const HostSurfaces* host) {
  record_until_sweeps(recorder, plan, in, host);
  scope(recorder, "volume_light", [&] {
    smoke_.record_volume_sweeps(recorder, plan, in);
    smoke_.record_volume_light(recorder, plan, in);
  });
}

void Renderer::record_until_sweeps(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                                   const HostSurfaces* host) {
  scope(recorder, "upload", [&] { record_upload(recorder, plan, in); });
  scope(recorder, "sky_light", [&] { scene_.record_level(recorder, plan, frame_); });
  scope(recorder, "gbuffer", [&] { record_surfaces(recorder, plan, host); });
  if (host) record_on_surfaces(recorder, plan, *host);
  scope(recorder, "density", [&] { smoke_.record_density(recorder, plan, in); });
  scope(recorder, "glow", [&] { smoke_.record_glow(recorder, plan); });
  if (plan.indirect_light.slices.count > 0)
    scope(recorder, "indirect_light", [&] {
      scene_.record_indirect_light(recorder, plan, frame_,
                                   {smoke_.resources(), smoke_.holes().cells, smoke_.noise(),
                                    smoke_.lit_volumes(), smoke_.glow_field()});
    });
  scope(recorder, "light", [&] { smoke_.record_light(recorder, plan, in); });
}

void Renderer::record_media(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  scope(recorder, "march", [&] { smoke_.record_march(recorder, plan, in); });
  if (smoke_.march_tiles()) scope(recorder, "resolve", [&] { smoke_.record_resolve(recorder, plan, in); });
}

void Renderer::record_accumulate(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  if (smoke_.is_accumulated())
    scope(recorder, "accumulate", [&] { smoke_.record_accumulate(recorder, plan, in); });
}

void Renderer::record_image(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  record_accumulate(recorder, plan, in);
  const bool is_debug_view = plan.input.debug.view != planning::DebugView::none;
  begin_decals(plan, !is_debug_view);
  if (is_debug_view && antialias_pass_) antialias_pass_->invalidate_past();
  if (is_debug_view) return scope(recorder, "debug_view", [&] { record_debug_view(recorder, plan); });
  if (!plan.decals.empty()) scope(recorder, "decals", [&] { record_decals(recorder, plan); });
  const passes::ShadePass::Needs needs = shade_needs(plan, shading_displays_ && !scene_.has_panes());
  scope(recorder, "shade", [&] {
    shade_pass_->record(recorder, needs,
                        {frame_, scene_.resources(), scene_.shadows(), smoke_.shadows(), scene_.level(),
                         targets_.gbuffer, media(), blue_noise_, occlusion_},
                        {targets_.radiance, targets_.display});
  });
  if (needs.display) return;
  if (scene_.has_panes()) scope(recorder, "panes", [&] { record_panes(recorder, plan); });
  if (!plan.particles.empty()) scope(recorder, "particles", [&] { record_particles(recorder, plan); });
  if (const planning::ViewSample& sample = plan.input.view.sample; sample.count > 1)
    scope(recorder, "average", [&] { average_pass_->record(recorder, targets_.radiance, sample.index); });
  if (antialias_pass_) scope(recorder, "antialias", [&] { record_antialias(recorder, plan); });
  scope(recorder, "display",
        [&] { display_pass_->record(recorder, frame_, blue_noise_, radiance(), targets_.display); });
}

void Renderer::record_antialias(gpu::Recorder& recorder, const FramePlan& plan) {
  const planning::View& view = plan.input.view;
  planning::ViewSample middle = view.sample;
  middle.pixel = {0, 0};
  antialias_pass_->record(recorder, {frame_, targets_.gbuffer.depth, media(), targets_.radiance},
                          planning::device_camera(view.camera, targets_.size_px, middle).clip_from_world,
                          view.sample.pixel, view.continues);
}

void Renderer::upload_decals(gpu::Recorder& recorder, const FramePlan& plan) {
  FrameVector<shared::Decal> decals(&recorder.memory());
  decals.reserve(plan.decals.size());
  for (const planning::PlacedDecal& placed : plan.decals) {
    decals.push_back(placed.decal);
    decals.back().occlusion = (*slices_)[placed.volume];
  }
  decal_pass_->upload(recorder, decals);
}

void Renderer::begin_decals(const FramePlan& plan, bool shows) {
  has_decals_ = !plan.input.decals.empty();
  occlusion_ = nullptr;
  if (decal_pass_ && (plan.decals.empty() || !shows)) decal_pass_->invalidate_past();
}

void Renderer::record_decals(gpu::Recorder& recorder, const FramePlan& plan) {
  decal_pass_->record(recorder, frame_, plan.camera, targets_.gbuffer, blue_noise_, slices_->image(),
                      plan.input.view.continues && smoke_.is_accumulated());
  occlusion_ = &decal_pass_->occlusion();
}

/// Decals are on the host's own surfaces, tanks are surfaces before them.
void Renderer::record_on_surfaces(gpu::Recorder& recorder, const FramePlan& plan, const HostSurfaces& host) {
  begin_decals(plan, true);
  if (has_decals_) scope(recorder, "decals", [&] { record_decals_on(recorder, plan, host.normals); });
  if (host.tanks) host.tanks->record_surfaces(recorder, targets_.gbuffer.depth, blue_noise_);
}

/// Where none is in view the host has an image, too: of 0.
void Renderer::record_decals_on(gpu::Recorder& recorder, const FramePlan& plan,
                                const passes::HostNormals& normals) {
  if (plan.decals.empty())
    decal_pass_->upload(recorder, {});
  else
    normal_pass_->record(recorder, frame_, normals, targets_.gbuffer);
  record_decals(recorder, plan);
  if (plan.decals.empty()) decal_pass_->invalidate_past();
}

void Renderer::record_upload(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  shared::FrameConstants frame = frame_constants(plan);
  frame.solid = scene_.level().solid.layout();
  frame.indirect = scene_.indirect_layout(plan);
  frame.march_scale = smoke_.march_scale();
  recorder.upload(frame_, 0, std::as_bytes(std::span(&frame, 1)));
  scene_.record_lights(recorder, plan);
  smoke_.record_upload(recorder, plan, in);
  if (!plan.decals.empty()) upload_decals(recorder, plan);
}

void Renderer::record_panes(gpu::Recorder& recorder, const FramePlan& plan) {
  scene_.record_panes(recorder, plan,
                      {frame_, scene_.shadows(), smoke_.shadows(), scene_.level(), targets_.gbuffer.depth,
                       media(), smoke_.resources(), smoke_.holes().cells, smoke_.lit_volumes()},
                      targets_.radiance);
}

void Renderer::record_particles(gpu::Recorder& recorder, const FramePlan& plan) {
  particle_pass_->record(recorder, {frame_, slices_->image(), targets_.gbuffer.depth}, plan.particles,
                         targets_.radiance);
}

void Renderer::record_debug_view(gpu::Recorder& recorder, const FramePlan& plan) {
  if (plan.input.debug.view == planning::DebugView::overdraw) {
    recorder.clear(targets_.radiance, {});
    if (!plan.particles.empty())
      particle_pass_->record_overdraw(recorder, {frame_, slices_->image(), targets_.gbuffer.depth},
                                      plan.particles, targets_.radiance);
  }
  debug_view_->record(recorder, debug_subject(plan),
                      {frame_, targets_.gbuffer, smoke_.resources(), smoke_.holes(), targets_.radiance},
                      targets_.display);
}

}  // namespace brume::render
