#include "render/renderer.hpp"

#include "passes/blue_noise.hpp"
#include "planning/frame_constants.hpp"

namespace brume::render {
namespace {

std::uint32_t bricks_of(glm::ivec3 atlas) {
  return static_cast<std::uint32_t>(atlas.x * atlas.y * atlas.z);
}

std::size_t most_lights(const LevelPart& level) {
  return level.resources().light_list.size() + planning::kMaxFlashes;
}

}  // namespace

Renderer::Renderer(gpu::Context& context, gpu::CommandStream& stream, const scene::Scene& scene,
                   const RendererOptions& options)
    : context_(context),
      stream_(stream),
      targets_(options.media_alone ? Targets::of_media(context, options.size_px)
                                   : Targets(context, options.size_px)),
      frame_(context, sizeof(shared::FrameConstants),
             VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT |
                 VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      level_(context, stream, scene,
             options.media_alone ? LevelPart::Surfaces::of_host : LevelPart::Surfaces::of_scene),
      smoke_(context, stream, most_lights(level_), options.size_px, options.smoke),
      volumes_(context, stream),
      march_(context, stream, options.size_px, options.smoke),
      slices_(context, stream),
      decals_(context),
      particles_(context),
      smoke_budget_(options.smoke.reserved_bricks),
      memory_follows_view_(options.smoke.memory_follows_view) {
  if (options.smoke.prepare_all) level_.prepare();
  // The surfaces of a host, or a picture of its own.
  if (options.media_alone)
    host_.emplace(context);
  else
    picture_.emplace(context, options.size_px,
                     PicturePart::Options{options.antialias, options.smoke.prepare_all, level_.has_panes()});
  if (options.motion) motion_.emplace(context, options.size_px);
  stream.run([&](gpu::Recorder& recorder) { blue_noise_ = passes::make_blue_noise(context, recorder); });
}

void Renderer::set_march_scale(std::uint32_t scale) {
  march_.set_march_scale(scale);
}

void Renderer::resize(glm::uvec2 size_px) {
  targets_ = host_ ? Targets::of_media(context_, size_px) : Targets(context_, size_px);
  smoke_.resize(size_px);
  march_.resize(size_px);
  decals_.resize();
  if (picture_) picture_->resize(size_px);
  if (host_) host_->resize();
  if (motion_) motion_->resize(size_px);
  if (tanks_) tanks_->resize(size_px);
  recorded_.change(context_).has_shadows = false;
  history_.smoke_shadows.invalidate();
}

void Renderer::set_masks(const smoke::MaskAtlas& masks) {
  smoke_.set_masks(masks);
  history_.smoke_shadows.invalidate();
  history_.smoke_light.invalidate();
}

void Renderer::set_lights(const std::vector<scene::Light>& lights) {
  commit_recorded();
  level_.set_lights(lights);
  forget_light();
}

void Renderer::set_scene(const scene::Scene& scene) {
  commit_recorded();
  level_.set_scene(scene);
  forget_light();
}

void Renderer::forget_light() {
  smoke_.set_most_lights(most_lights(level_), targets_.size_px);
  history_.invalidate_light();
}

void Renderer::invalidate() {
  history_.invalidate();
}

void Renderer::invalidate_level() {
  invalidate();
  level_.invalidate();
}

/// The size of a frame.
glm::uvec2 Renderer::size_of(const FrameInput& input) const {
  const glm::uvec2 size_px = input.view.size_px;
  if (size_px == glm::uvec2(0) || size_px == targets_.size_px) return targets_.size_px;
  const bool fits = host_ && glm::all(glm::greaterThan(size_px, glm::uvec2(0))) &&
                    glm::all(glm::lessThanEqual(size_px, targets_.size_px));
  if (!fits) throw Error(ErrorCode::bad_input, "a picture must be from 1 x 1 pixels to the renderer's size");
  return size_px;
}

planning::PlanTarget Renderer::plan_target(const FrameInput& input) const {
  const passes::SceneResources& scene = level_.resources();
  return {scene.light_list,
          {scene.bounds_min, scene.bounds_max},
          scene.emitters,
          level_.shadows().sun_clip_from_world,
          size_of(input),
          glm::uvec2(smoke_.shadows().atlas.info().size),
          slices_.textures(),
          {smoke_budget_.atlas_bricks(), smoke_budget_.most_bricks(), smoke_.light_room(),
           volumes_.light_room(), level_.holds_indirect_light()},
          holds_all_smoke()};
}

/// Commits the history of the last plan if its frame was recorded. A dropped recording leaves it as it was.
void Renderer::commit_recorded() {
  if (recorded_.get(context_).plan == history_.plans) history_.commit();
}

FramePlan Renderer::plan(const FrameInput& input) {
  if (input.view.projection == planning::Projection::parallel && (!host_ || !input.tanks.empty()))
    throw Error(ErrorCode::bad_input, "a picture of surfaces or tanks of its own needs a perspective camera");
  commit_recorded();

  // Smoke gives memory back where its budget shrank.
  const std::uint32_t room = bricks_of(smoke_.atlas_bricks());
  const std::uint32_t wanted = holds_all_smoke() ? room : history_.resident->wanted_count();
  if (smoke_budget_.begin_frame(context_.memory(), room, wanted)) {
    smoke_.trim(smoke_budget_.atlas_bricks());
    invalidate();
  }

  // A shortage of memory shows only when memory is allocated: then the frame is planned with less smoke.
  while (true) {
    std::optional<gpu::Memory::Unlimited> reserve;
    if (smoke_budget_.is_reserve()) reserve.emplace(context_.memory());
    try {
      return try_plan(input);
    } catch (const Error& error) {
      const bool is_full = error.code() == ErrorCode::resource_limit;
      if (!is_full || !input.smoke.volume || !smoke_budget_.reduce(bricks_of(smoke_.atlas_bricks()))) throw;
    }
  }
}

FramePlan Renderer::try_plan(const FrameInput& input) {
  volumes_.prepare(input, history_.volume_streaming);
  slices_.prepare(input);
  if (!input.tanks.empty() && picture_ && !tanks_)
    tanks_.emplace(context_, stream_, targets_.size_px, TanksPart::Over::level);
  if (tanks_) tanks_->prepare(input, size_of(input));
  FramePlan plan = planning::plan_frame(input, plan_target(input), history_);
  reserve(plan);
  return plan;
}

void Renderer::reserve(const FramePlan& plan) {
  level_.reserve(plan);
  smoke_.reserve(plan);
  volumes_.reserve(plan);
  march_.reserve(plan);
  if (!plan.decals.empty()) decals_.reserve(plan.input.view.index, targets_.size_px);
  if (!plan.decals.empty() && host_) host_->reserve_normals(targets_);
  if (!picture_) return;
  particles_.reserve(plan);
  picture_->reserve(plan);
}

void Renderer::reserve_over(const HostNeeds& needs) {
  if (needs.decals) {
    decals_.reserve(needs.view, targets_.size_px);
    host_->reserve_normals(targets_);
  }
  if (needs.samples) host_->reserve_samples();
  if (needs.shadows) host_->reserve_shadows(targets_.size_px);
  if (needs.picture != VK_FORMAT_UNDEFINED) host_->reserve_layer(needs.picture);
  if (needs.tanks && !tanks_) tanks_.emplace(context_, stream_, targets_.size_px, TanksPart::Over::host);
}

void Renderer::draw(const FrameInput& input, const std::function<void(gpu::Recorder&)>& then) {
  const FramePlan plan = this->plan(input);
  stream_.run([&](gpu::Recorder& recorder) {
    record_frame(recorder, plan);
    if (then) then(recorder);
  });
}

FrameResources Renderer::resources(const FramePlan& plan) const {
  BRUME_ASSERT(plan.number == history_.plans, "a plan that another one or invalidate() has replaced");
  const auto media = [&](std::uint32_t set, const passes::VolumeResources& volumes) {
    return passes::MediaResources{set, smoke_.resources(), smoke_.holes(), volumes};
  };
  return {.frame = frame_,
          .targets = targets_,
          .surfaces = surfaces(),
          .blue_noise = blue_noise_,
          .scene = level_.resources(),
          .shadows = level_.shadows(),
          .level = level_.light(),
          .media = media(plan.media.media, volumes_.resources()),
          .lit_media = media(plan.media.casters, volumes_.lit_resources()),
          .media_light = {smoke_.fine_light().light(), smoke_.fine_light().pages(), volumes_.light().light(),
                          volumes_.light().sun_depths()},
          .noise = march_.noise(),
          .detail = march_.detail(),
          .smoke_shadows = smoke_.shadows(),
          .glow_field = volumes_.glow_field(),
          .step_counters = picture_ ? picture_->step_counters(plan) : nullptr};
}

// The kinds of frames: on our own surfaces, of a part of a volume, over a host's surfaces. TankPicture draws
// a tank alone; it shares only the tank's samples with these.

void Renderer::record_frame(gpu::Recorder& recorder, const FramePlan& plan) {
  for (int part = 0; part < kParts; ++part) record_part(recorder, plan, part);
}

void Renderer::record_part(gpu::Recorder& recorder, const FramePlan& plan, int part) {
  const FrameResources in = resources(plan);
  if (part == 0) record_light(recorder, plan, in, nullptr);
  if (part == 1) record_march(recorder, plan, in);
  if (part == 2) record_picture(recorder, plan, in);
}

void Renderer::record_sweeps(gpu::Recorder& recorder, const FramePlan& plan) {
  const FrameResources in = resources(plan);
  record_until_sweeps(recorder, plan, in, nullptr);
  scope(recorder, "sweeps", [&] { volumes_.record_sweeps(recorder, plan, in); });
}

void Renderer::record_rays(gpu::Recorder& recorder, const FramePlan& plan) {
  const FrameResources in = resources(plan);
  scope(recorder, "volume_light", [&] { volumes_.record_light(recorder, plan, in); });
  record_march(recorder, plan, in);
}

void Renderer::record_picture(gpu::Recorder& recorder, const FramePlan& plan) {
  record_picture(recorder, plan, resources(plan));
}

void Renderer::record_over(gpu::Recorder& recorder, const FramePlan& plan, const HostFrame& host) {
  const FrameResources in = resources(plan);
  record_light(recorder, plan, in, &host.surfaces);
  record_march(recorder, plan, in);
  if (motion_) motion_->record(recorder, plan, in, march_.counters());
  march_.record_accumulate(recorder, plan, in);
  if (tanks_) tanks_->record_layers(recorder, media());
  recorder.change(recorded_).has_shadows = !host.shadow_lights.empty();
  if (!host.shadow_lights.empty()) host_->record_shadows(recorder, plan, in, host.shadow_lights);
  if (host.picture)
    host_->record_layer(recorder, {layers(), occlusion(), host.exposure}, *host.picture,
                        {host.surfaces.origin_px, plan.size_px});
}

const gpu::Image& Renderer::layers() const {
  const gpu::Image* with_tanks = tanks_ ? tanks_->layers() : nullptr;
  return with_tanks ? *with_tanks : media();
}

const gpu::Image& Renderer::surfaces() const {
  const gpu::Image* with_tanks = tanks_ ? tanks_->surfaces() : nullptr;
  return with_tanks ? *with_tanks : targets_.gbuffer.depth;
}

const gpu::Image* Renderer::shadows() const {
  return recorded_.get(context_).has_shadows ? &host_->shadows() : nullptr;
}

// The steps of a frame.

void Renderer::upload(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  shared::FrameConstants frame = planning::frame_constants(plan);
  frame.solid = level_.light().solid.layout();
  frame.indirect = level_.indirect_layout(plan);
  frame.march_scale = march_.march_scale();
  recorder.upload(frame_, 0, std::as_bytes(std::span(&frame, 1)));
  level_.upload(recorder, plan);
  march_.upload(recorder, in);
  smoke_.upload(recorder, plan);
  volumes_.upload(recorder, plan);
  decals_.upload(recorder, plan, slices_);
}

/// Records what precedes the sweeps through volumes: uploads, surfaces, densities, the light in smoke.
void Renderer::record_until_sweeps(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                                   const HostSurfaces* host) {
  recorder.change(recorded_) = {plan.number, plan.smoke ? plan.smoke->level() : 0,
                                !holds_all_smoke() && history_.resident->is_missing()};
  scope(recorder, "upload", [&] { upload(recorder, plan, in); });

  // The surfaces.
  scope(recorder, "sky_light", [&] { level_.record_light(recorder, plan, in); });
  scope(recorder, "gbuffer", [&] {
    if (host) return host_->record_depth(recorder, plan, in, *host);
    level_.record_gbuffer(recorder, plan, in);
  });
  if (host) record_on_host(recorder, plan, in, *host);
  if (tanks_) tanks_->record_surfaces(recorder, targets_.gbuffer.depth, blue_noise_);

  // The media, and the light in the smoke.
  scope(recorder, "density", [&] { smoke_.record_density(recorder, plan, in); });
  scope(recorder, "glow", [&] { volumes_.record_glow(recorder, plan); });
  level_.record_indirect_light(recorder, plan, in);
  scope(recorder, "light", [&] { smoke_.record_light(recorder, plan, in); });
}

/// Records the decals on the host's surfaces, before tanks become surfaces in front of them.
void Renderer::record_on_host(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                              const HostSurfaces& host) {
  decals_.begin(recorder, plan);
  if (!plan.input.decals.empty())
    scope(recorder, "decals", [&] {
      if (!plan.decals.empty()) host_->record_normals(recorder, plan, in, host);
      decals_.record(recorder, plan, in, slices_, march_.is_accumulated());
    });
}

/// Records everything that later frames rely on: all that the plan's history counts as updated.
void Renderer::record_light(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                            const HostSurfaces* host) {
  record_until_sweeps(recorder, plan, in, host);
  scope(recorder, "volume_light", [&] {
    volumes_.record_sweeps(recorder, plan, in);
    volumes_.record_light(recorder, plan, in);
  });
}

void Renderer::record_march(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  march_.record(recorder, plan, in);
}

void Renderer::record_picture(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) {
  march_.record_accumulate(recorder, plan, in);
  if (tanks_) tanks_->record_layers(recorder, media());
  decals_.begin(recorder, plan);

  // A debug view takes the place of the picture.
  const planning::DebugView view = plan.input.debug.view;
  if (view != planning::DebugView::none) {
    decals_.forget(recorder, plan.input.view.index);
    return scope(recorder, "debug_view", [&] {
      if (view == planning::DebugView::overdraw) particles_.record_overdraw(recorder, plan, in, slices_);
      picture_->record_debug_view(recorder, plan, in);
    });
  }

  // Surfaces; then, unless shading has displayed the picture already, what is drawn over them.
  if (!plan.decals.empty())
    scope(recorder, "decals", [&] { decals_.record(recorder, plan, in, slices_, march_.is_accumulated()); });
  if (picture_->record_shade(recorder, plan, in, layers(), occlusion())) return;
  level_.record_panes(recorder, plan, in, media(), layers());
  particles_.record(recorder, plan, in, slices_);
  picture_->record_display(recorder, plan, in, media());
}

}  // namespace brume::render
