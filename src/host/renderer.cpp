#include "api/smoke_field.hpp"
#include "host/frame.hpp"
#include "host/objects.hpp"

using namespace brume::api;

brume_renderer::brume_renderer(std::shared_ptr<Settings> of, std::shared_ptr<brume::host::DeviceData> on,
                               brume::scene::Scene of_scene,
                               std::shared_ptr<const brume::smoke::MaskAtlas> of_masks,
                               const brume::render::RendererOptions& with)
    : Handle(kKind, std::move(of)),
      device(std::move(on)),
      scene(std::move(of_scene)),
      masks(std::move(of_masks)),
      options(with),
      recording(device->context),
      layer(device->context) {
  options.smoke.masks = masks.get();
  ++device->renderers;
}

brume_renderer::~brume_renderer() {
  --device->renderers;
}

namespace brume::host {
namespace {

constexpr std::uint32_t kMostPixels = 16384;

glm::uvec2 checked_size(std::uint32_t width, std::uint32_t height) {
  require(width >= 1 && width <= kMostPixels && height >= 1 && height <= kMostPixels,
          "`width` and `height` must be from 1 to 16384");
  return {width, height};
}

void create_renderer(Call& call, brume_device* device, const brume_renderer_params* given,
                     brume_renderer** renderer) {
  const brume_device& on = call.handle(device);
  required(renderer, "renderer");
  const brume_renderer_params params = params_or(given, brume_renderer_defaults());
  render::RendererOptions options;
  options.size_px = checked_size(params.width, params.height);
  const bool is_scale = params.march_scale == 1 || params.march_scale == 2 || params.march_scale == 4;
  require(is_scale, "`march_scale` must be 1, 2 or 4");
  options.smoke.march_scale = params.march_scale;
  options.smoke.temporal = params.temporal != 0;
  options.media_alone = true;
  const std::scoped_lock lock(on.data->mutex);
  create(renderer, on.settings, on.data, scene_of(params), atlas_of(call, params.masks), options);
}

void check_frame(const brume_renderer& of, const brume_field& field, const brume_frame_params& params) {
  require(params.commands != VK_NULL_HANDLE, "`commands` is null");
  if (params.frame <= of.device->frame)
    fail(BRUME_ERROR_ORDER, "`frame` is " + std::to_string(params.frame) + ", the last one was " +
                                std::to_string(of.device->frame));
  require(params.completed < params.frame, "`completed` must be below `frame`");
  if (params.completed < of.device->completed)
    fail(BRUME_ERROR_ORDER, "`completed` was " + std::to_string(of.device->completed) + " before");
  const sim::MaskKey masks = of.masks ? of.masks->key() : sim::MaskKey{};
  if (field.field->masks() != masks)
    fail(BRUME_ERROR_MISMATCH, "the field has other masks than the renderer");
  if (params.picture.view == VK_NULL_HANDLE) return;
  require(params.picture.format != VK_FORMAT_UNDEFINED, "`picture.format` is undefined");
  require(params.picture.exposure > 0 && params.picture.exposure < 1e9f,
          "`picture.exposure` must be above 0");
}

void draw(brume_renderer& of, const brume_frame_params& params, const planning::FrameInput& input,
          const passes::HostDepthRange& range) {
  if (!of.renderer) of.renderer.emplace(of.device->context, of.recording, of.scene, of.options);
  render::Renderer& renderer = *of.renderer;
  if (const std::uint64_t volume = input.smoke.volume->volume().id(); volume != of.shown_volume) {
    renderer.invalidate();
    of.shown_volume = volume;
  }
  if (params.picture.view) of.layer.reserve(params.picture.format);
  const planning::FramePlan plan = renderer.plan(input);
  const glm::uvec2 size_px = of.options.size_px;
  const gpu::Image depth(
      {VK_NULL_HANDLE, params.depth.view, VK_FORMAT_D32_SFLOAT, size_px, params.depth.layout});
  renderer.record_media_over(of.recording.recorder(), plan, {depth, range});
  if (!params.picture.view) return;
  const gpu::Image picture({VK_NULL_HANDLE, params.picture.view, params.picture.format, size_px,
                            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL});
  const gpu::Scope timed(of.recording.recorder(), "layer");
  of.layer.record(of.recording.recorder(), renderer.media(), params.picture.exposure, picture);
}

void record(brume_renderer& of, const brume_field& field, const brume_frame_params& params) {
  check_frame(of, field, params);
  const passes::HostDepthRange range = depth_range(params.depth);
  const planning::FrameInput input = frame_input(params, *field.field);
  // Taken even where the frame fails: the next one has a higher number.
  of.device->frame = params.frame;
  of.device->completed = params.completed;
  of.recording.begin(params.commands, params.frame, params.completed);
  try {
    draw(of, params, input, range);
  } catch (...) {
    // What it holds may be half of what it planned: the next frame makes another.
    of.renderer.reset();
    of.recording.end();
    throw;
  }
  of.recording.end();
}

brume_timing timing_of(const gpu::Timings::Scope& scope) {
  brume_timing timing{};
  scope.name.copy(timing.name, sizeof timing.name - 1);
  timing.milliseconds = scope.milliseconds;
  return timing;
}

}  // namespace
}  // namespace brume::host

extern "C" {

brume_result brume_renderer_create(brume_device* device, const brume_renderer_params* params,
                                   brume_renderer** renderer) BRUME_NOEXCEPT {
  return Call(__func__).run(
      [&](Call& call) { brume::host::create_renderer(call, device, params, renderer); });
}

brume_result brume_renderer_destroy(brume_renderer* renderer) BRUME_NOEXCEPT {
  if (!renderer) return BRUME_OK;
  return Call(__func__).run([&](Call& call) {
    const std::shared_ptr<brume::host::DeviceData> device = call.handle(renderer).device;
    const std::scoped_lock lock(device->mutex);
    delete renderer;
  });
}

brume_result brume_renderer_resize(brume_renderer* renderer, uint32_t width, uint32_t height) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_renderer& of = call.handle(renderer);
    const glm::uvec2 size_px = brume::host::checked_size(width, height);
    const std::scoped_lock lock(of.mutex, of.device->mutex);
    of.options.size_px = size_px;
    try {
      if (of.renderer) of.renderer->resize(size_px);
    } catch (...) {
      of.renderer.reset();
      throw;
    }
  });
}

brume_result brume_renderer_record(brume_renderer* renderer, const brume_field* field,
                                   const brume_frame_params* params) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_renderer& of = call.handle(renderer);
    const brume_field& from = call.handle(field);
    const brume_frame_params frame = required_params(params, brume_frame_defaults());
    const std::scoped_lock lock(of.mutex, of.device->mutex);
    call.read(from, [&] { brume::host::record(of, from, frame); });
  });
}

brume_result brume_renderer_smoke(const brume_renderer* renderer, VkImage* image,
                                  VkImageView* view) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_renderer& of = call.handle(renderer);
    call.read(of, [&] {
      if (!of.renderer) fail(BRUME_ERROR_ORDER, "a frame must be recorded first");
      if (image) *image = of.renderer->media().handle();
      if (view) *view = of.renderer->media().view();
    });
  });
}

brume_result brume_renderer_timings(const brume_renderer* renderer, brume_timing* timings, size_t capacity,
                                    size_t* count) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_renderer& of = call.handle(renderer);
    call.read(of, [&] {
      std::vector<brume_timing> list;
      for (const auto& scope : of.recording.timings()) list.push_back(brume::host::timing_of(scope));
      write_list(std::span<const brume_timing>(list), timings, capacity, count);
    });
  });
}

}  // extern "C"
