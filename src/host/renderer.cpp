#include "api/smoke_field.hpp"
#include "host/decals.hpp"
#include "host/frame.hpp"
#include "host/objects.hpp"
#include "host/tanks.hpp"
#include "host/volumes.hpp"
#include "shared/surface_import.h"

using namespace brume::api;

brume_renderer::brume_renderer(std::shared_ptr<Settings> context_settings,
                               std::shared_ptr<brume::host::DeviceData> device_data,
                               brume::scene::Scene renderer_scene,
                               std::shared_ptr<const brume::smoke::MaskAtlas> mask_atlas,
                               const brume::render::RendererOptions& renderer_options, bool timed)
    : Handle(kKind, std::move(context_settings)),
      device(std::move(device_data)),
      scene(std::move(renderer_scene)),
      masks(std::move(mask_atlas)),
      options(renderer_options),
      recording(device->context, timed) {
  options.smoke.masks = masks.get();
  ++device->renderers;
}

brume_renderer::~brume_renderer() {
  --device->renderers;
}

namespace brume::host {
namespace {

static_assert(BRUME_MAX_SHADOW_LIGHTS == shared::kMaxSurfaceShadows);
static_assert(BRUME_MAX_VIEWS == planning::kMaxViews);

void create_renderer(Call& call, brume_device* device, const brume_renderer_params* given,
                     brume_renderer** renderer) {
  const brume_device& owner = call.handle(device);
  required(renderer, "renderer");
  const brume_renderer_params params = params_or_defaults(given);
  const render::RendererOptions options = renderer_options(params);
  const std::scoped_lock lock(owner.data->mutex);
  create(renderer, owner.settings, owner.data, to_scene(params), atlas_of(call, params.masks), options,
         params.timings != 0);
}

void check_frame(const brume_renderer& renderer, const brume_field* field, const brume_frame_params& params) {
  require(params.commands != VK_NULL_HANDLE, "`commands` is null");
  if (params.frame_number < std::max<std::uint64_t>(renderer.device->frame, 1))
    fail(BRUME_ERROR_ORDER, "`frame_number` is " + std::to_string(params.frame_number) +
                                ", the last one was " + std::to_string(renderer.device->frame));
  require(params.completed_frame < params.frame_number, "`completed_frame` must be below `frame_number`");
  if (params.completed_frame < renderer.device->completed)
    fail(BRUME_ERROR_ORDER,
         "`completed_frame` was " + std::to_string(renderer.device->completed) + " before");
  const sim::MaskKey masks = renderer.masks ? renderer.masks->key() : sim::MaskKey{};
  if (field && field->field->smoke().masks() != masks)
    fail(BRUME_ERROR_MISMATCH, "the field has other masks than the renderer");
  const brume_rectangle& part = params.part;
  const glm::uvec2 most = renderer.options.size_px;
  require((part.width == 0 && part.height == 0) ||
              (part.width >= 1 && part.width <= most.x && part.height >= 1 && part.height <= most.y),
          "`part` must be at least 1 pixel wide and high, and at most as large as the renderer");
  require(part.x <= kMostPixels && part.y <= kMostPixels && (part.width > 0 || (part.x == 0 && part.y == 0)),
          "`part` must begin within 16384 pixels, and at 0, 0 without a size");
  if (params.picture.view == VK_NULL_HANDLE) return;
  require(can_blend(renderer.device->context, params.picture.format),
          "`picture.format` must be one that the device can blend");
  require(params.picture.exposure > 0 && params.picture.exposure < 1e9f,
          "`picture.exposure` must be above 0");
}

/// What a frame needs whatever it shows, which no limit of memory refuses.
void reserve(brume_renderer& renderer, const brume_frame_params& params) {
  const gpu::Memory::Unlimited always(renderer.device->context.memory());
  try {
    if (renderer.renderer && renderer.change == brume_renderer::Change::lights)
      renderer.renderer->set_lights(renderer.scene.lights);
    if (renderer.renderer && renderer.change == brume_renderer::Change::triangles)
      renderer.renderer->set_scene(renderer.scene);
  } catch (...) {
    renderer.drop();  // some of it has the lights and triangles before
    throw;
  }
  if (!renderer.renderer)
    renderer.renderer.emplace(renderer.device->context, renderer.recording, renderer.scene, renderer.options);
  renderer.change = brume_renderer::Change::none;
  renderer.renderer->reserve_over(
      {.view = params.view,
       .decals = params.decal_count > 0,
       .shadows = params.shadow_light_count > 0,
       .tanks = params.tank_count > 0,
       .samples = params.depth_has_samples != 0,
       .picture = params.picture.view ? params.picture.format : VK_FORMAT_UNDEFINED});
}

void check_shadow_lights(const brume_renderer& renderer, const brume_frame_params& params) {
  require(params.shadow_light_count <= BRUME_MAX_SHADOW_LIGHTS, "`shadow_light_count` must be at most 4");
  const std::size_t lights = renderer.scene.lights.size() + params.light_count;
  for (std::uint32_t i = 0; i < params.shadow_light_count; ++i)
    if (params.shadow_lights[i] >= lights)
      refuse("`shadow_lights` has " + std::to_string(params.shadow_lights[i]) + ", but there are " +
             std::to_string(lights) + " lights");
}

/// A frame of one view, checked; its input is the renderer's.
struct CheckedView {
  passes::HostDepthRange range;
  passes::HostNormals normals;
  ShownVolumes volumes;
};
CheckedView checked_view(Call& call, brume_renderer& renderer, const brume_field* field,
                         const brume_frame_params& params) {
  check_frame(renderer, field, params);
  CheckedView view{depth_range(params), host_normals(params.normals), {}};
  planning::FrameInput& input = renderer.input;
  set_frame_input(params, field ? &*field->field : nullptr, input);
  check_shadow_lights(renderer, params);
  view.volumes = add_volumes(call, params, input);
  add_decals(call, params, renderer);
  add_tanks(call, params, input);
  return view;
}

void draw(brume_renderer& renderer, const brume_frame_params& params, const CheckedView& view) {
  reserve(renderer, params);
  const planning::FrameInput& input = renderer.input;
  const std::uint64_t volume = input.smoke.volume ? input.smoke.volume->id() : 0;
  if (volume != renderer.shown_volume) {
    renderer.renderer->invalidate_level();
    renderer.shown_volume = volume;
  }
  const planning::FramePlan plan = renderer.renderer->plan(input);

  // The host's images, as long as the frame is recorded.
  const glm::uvec2 size_px = renderer.options.size_px;
  const gpu::Image depth(
      {VK_NULL_HANDLE, params.depth.view, VK_FORMAT_D32_SFLOAT, size_px, params.depth.layout});
  const gpu::Image normal_image(
      {VK_NULL_HANDLE, params.normals.view, VK_FORMAT_R16G16B16A16_SFLOAT, size_px, params.normals.layout});
  const gpu::Image picture({VK_NULL_HANDLE, params.picture.view, params.picture.format, size_px,
                            VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL});
  passes::HostNormals normals = view.normals;
  if (params.normals.view) normals.image = &normal_image;
  renderer.renderer->record_over(renderer.recording.recorder(), plan,
                                 {.surfaces = {depth, view.range, {params.part.x, params.part.y}, normals},
                                  .shadow_lights = {params.shadow_lights, params.shadow_light_count},
                                  .picture = params.picture.view ? &picture : nullptr,
                                  .exposure = params.picture.exposure});
}

/// Checks a view of several: failures name it.
template <typename Check>
void of_view(std::size_t number, Check check) {
  try {
    check();
  } catch (const CallFailure& failure) {
    fail(failure.result, "view " + std::to_string(number) + ": " + failure.message);
  }
}

/// Checks views of one frame, of which none is recorded unless all are right.
void check_views(Call& call, brume_renderer& renderer, const brume_field* field,
                 std::span<const brume_frame_params> views) {
  std::uint32_t seen = 0;
  for (std::size_t i = 0; i < views.size(); ++i) {
    of_view(i, [&] {
      (void)checked_view(call, renderer, field, views[i]);
      require((seen >> views[i].view & 1) == 0, "an earlier one has the same `view`");
      require(views[i].commands == views[0].commands && views[i].frame_number == views[0].frame_number &&
                  views[i].completed_frame == views[0].completed_frame,
              "`commands`, `frame_number` and `completed_frame` must be the same in all views");
    });
    seen |= 1u << views[i].view;
  }
}

/// Nothing of a frame is recorded; the next one works.
void discard(brume_renderer& renderer) {
  const bool has_several = renderer.recording.has_several_views();
  renderer.recording.discard();
  if (has_several) renderer.drop();  // earlier views count as drawn in it
  renderer.input.slices.reset();     // with spare decals, which may not fit
  renderer.sliced.clear();
}

void record(Call& call, brume_renderer& renderer, const brume_field* field,
            std::span<const brume_frame_params> views) {
  CheckedView view = checked_view(call, renderer, field, views[0]);
  // Taken even where the frame fails.
  renderer.device->frame = views[0].frame_number;
  renderer.device->completed = views[0].completed_frame;
  renderer.has_frame = false;
  renderer.recording.begin(views[0].commands, views[0].frame_number, views[0].completed_frame);
  try {
    draw(renderer, views[0], view);
    for (const brume_frame_params& next : views.subspan(1)) {
      renderer.recording.begin_view();
      view = checked_view(call, renderer, field, next);
      draw(renderer, next, view);
    }
    renderer.recording.end();
    renderer.has_frame = true;
  } catch (...) {
    discard(renderer);
    throw;
  }
}

brume_timing timing_of(const gpu::Timings::Scope& scope) {
  brume_timing timing{};
  scope.name.copy(timing.name, sizeof timing.name - 1);
  timing.milliseconds = scope.milliseconds;
  return timing;
}

/// Where a host wants to have an image of a renderer; null: not.
struct ImageOut {
  VkImage* image;
  VkImageView* view;
};
/// Writes the image that `find` finds in a renderer whose last frame was recorded; where it is null, fails.
template <typename Find>
brume_result write_image(const char* function, const brume_renderer* renderer, const ImageOut& out,
                         const char* missing, Find find) {
  return Call(function).run([&](Call& call) {
    const brume_renderer& object = call.handle(renderer);
    call.read(object, [&] {
      const gpu::Image* const found = object.has_frame ? find(*object.renderer) : nullptr;
      if (!found) fail(BRUME_ERROR_ORDER, missing);
      if (out.image) *out.image = found->handle();
      if (out.view) *out.view = found->view();
    });
  });
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
    brume_renderer& object = call.handle(renderer);
    const glm::uvec2 size_px = brume::host::checked_size(width, height);
    const std::scoped_lock lock(object.mutex, object.device->mutex);
    object.options.size_px = size_px;
    const brume::gpu::Memory::Unlimited always(object.device->context.memory());
    try {
      if (object.renderer) object.renderer->resize(size_px);
    } catch (...) {
      object.drop();  // some of it has the size before
      throw;
    }
  });
}

brume_result brume_renderer_set_march_scale(brume_renderer* renderer, uint32_t march_scale) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_renderer& object = call.handle(renderer);
    const std::uint32_t scale = brume::host::checked_scale(march_scale);
    const std::scoped_lock lock(object.mutex, object.device->mutex);
    object.options.smoke.march_scale = scale;
    const brume::gpu::Memory::Unlimited always(object.device->context.memory());
    try {
      if (object.renderer) object.renderer->set_march_scale(scale);
    } catch (...) {
      object.drop();
      throw;
    }
  });
}

brume_result brume_renderer_set_lights(brume_renderer* renderer, const brume_light* lights,
                                       size_t light_count) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_renderer& object = call.handle(renderer);
    std::vector<brume::scene::Light> changed = brume::host::scene_lights(lights, light_count);
    const std::scoped_lock lock(object.mutex, object.device->mutex);
    object.scene.lights = std::move(changed);
    object.change = std::max(object.change, brume_renderer::Change::lights);
  });
}

brume_result brume_renderer_set_triangles(brume_renderer* renderer, const brume_point* points,
                                          size_t point_count, const uint32_t* indices,
                                          size_t index_count) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_renderer& object = call.handle(renderer);
    brume::scene::Scene changed =
        brume::host::scene_of_triangles({points, point_count}, {indices, index_count});
    const std::scoped_lock lock(object.mutex, object.device->mutex);
    std::swap(changed.lights, object.scene.lights);
    object.scene = std::move(changed);
    object.change = brume_renderer::Change::triangles;
  });
}

brume_result brume_renderer_record(brume_renderer* renderer, const brume_field* field,
                                   const brume_frame_params* params) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_renderer& object = call.handle(renderer);
    const brume_field* from = field ? &call.handle(field) : nullptr;
    const brume_frame_params frame = required_params(params);
    const std::scoped_lock lock(object.mutex, object.device->mutex);
    const auto record = [&] { brume::host::record(call, object, from, {&frame, 1}); };
    from ? call.read(*from, record) : record();
  });
}

brume_result brume_renderer_record_views(brume_renderer* renderer, const brume_field* field,
                                         const brume_frame_params* const* views,
                                         size_t view_count) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    brume_renderer& object = call.handle(renderer);
    const brume_field* from = field ? &call.handle(field) : nullptr;
    require(view_count >= 1 && view_count <= BRUME_MAX_VIEWS, "`view_count` must be from 1 to 4");
    const brume_frame_params* const* given = &required(views, "views");
    std::array<brume_frame_params, BRUME_MAX_VIEWS> frames;
    for (std::size_t i = 0; i < view_count; ++i) {
      if (!given[i]) refuse("`views[" + std::to_string(i) + "]` is null");
      brume::host::of_view(i, [&] { frames[i] = required_params(given[i]); });
    }
    const std::scoped_lock lock(object.mutex, object.device->mutex);
    const auto record = [&] {
      const std::span<const brume_frame_params> all(frames.data(), view_count);
      brume::host::check_views(call, object, from, all);
      brume::host::record(call, object, from, all);
    };
    from ? call.read(*from, record) : record();
  });
}

brume_result brume_renderer_smoke(const brume_renderer* renderer, VkImage* image,
                                  VkImageView* view) BRUME_NOEXCEPT {
  return brume::host::write_image(__func__, renderer, {image, view}, "a frame must be recorded first",
                                  [](const auto& from) { return &from.layers(); });
}

brume_result brume_renderer_coarseness(const brume_renderer* renderer, uint32_t* level,
                                       uint32_t* is_smoke_missing) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_renderer& object = call.handle(renderer);
    std::uint32_t& to = required(level, "level");
    call.read(object, [&] {
      if (!object.has_frame) fail(BRUME_ERROR_ORDER, "a frame must be recorded first");
      to = static_cast<std::uint32_t>(object.renderer->smoke_level());
      if (is_smoke_missing) *is_smoke_missing = object.renderer->is_smoke_missing();
    });
  });
}

brume_result brume_renderer_shadows(const brume_renderer* renderer, VkImage* image,
                                    VkImageView* view) BRUME_NOEXCEPT {
  return brume::host::write_image(__func__, renderer, {image, view},
                                  "a frame with `shadow_lights` must be recorded first",
                                  [](const auto& from) { return from.shadows(); });
}

brume_result brume_renderer_motion(const brume_renderer* renderer, VkImage* image,
                                   VkImageView* view) BRUME_NOEXCEPT {
  return brume::host::write_image(__func__, renderer, {image, view},
                                  "a renderer with `motion` must record a frame first",
                                  [](const auto& from) { return from.motion(); });
}

brume_result brume_renderer_occlusion(const brume_renderer* renderer, VkImage* image,
                                      VkImageView* view) BRUME_NOEXCEPT {
  return brume::host::write_image(__func__, renderer, {image, view},
                                  "a frame with `decals` must be recorded first",
                                  [](const auto& from) { return from.occlusion(); });
}

brume_result brume_renderer_timings(const brume_renderer* renderer, brume_timing* timings, size_t capacity,
                                    size_t* count) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call& call) {
    const brume_renderer& object = call.handle(renderer);
    call.read(object, [&] {
      std::vector<brume_timing> list;
      for (const auto& scope : object.recording.timings()) list.push_back(brume::host::timing_of(scope));
      write_list(std::span<const brume_timing>(list), timings, capacity, count);
    });
  });
}

}  // extern "C"
