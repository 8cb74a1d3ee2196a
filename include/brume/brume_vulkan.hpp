// The C interface of the renderer (brume_vulkan.h, brume_assets.h) for C++17, as brume.hpp is for brume.h.
//
//   brume::api::Device device(context, device_params);
//   brume::api::Renderer renderer(device, renderer_params);
//   renderer.record(&field, frame_params);
//
// A device is destroyed after its renderers: declare it before them.
#ifndef BRUME_BRUME_VULKAN_HPP
#define BRUME_BRUME_VULKAN_HPP

#include <brume/brume_vulkan.h>

#include <brume/brume.hpp>
#include <cstdint>
#include <vector>

namespace brume::api {

/// A brume_volume.
class Volume : public detail::Handle<brume_volume, brume_volume_destroy> {
 public:
  /// brume_volume_create.
  Volume(const Context& context, const brume_volume_params& params)
      : Handle(detail::created<brume_volume>(
            [&](brume_volume** out) { return brume_volume_create(context.get(), &params, out); })) {}

  /// brume_volume_describe.
  brume_volume_info describe() const {
    return detail::value_of<brume_volume_info>(
        [&](brume_volume_info* out) { return brume_volume_describe(get(), out); });
  }
  /// brume_shown_volume_defaults.
  brume_shown_volume shown() const { return brume_shown_volume_defaults(get()); }
};

/// A brume_decal.
class Decal : public detail::Handle<brume_decal, brume_decal_destroy> {
 public:
  /// brume_decal_create.
  Decal(const Context& context, const brume_decal_params& params)
      : Handle(detail::created<brume_decal>(
            [&](brume_decal** out) { return brume_decal_create(context.get(), &params, out); })) {}

  /// brume_shown_decal_defaults.
  brume_shown_decal shown() const { return brume_shown_decal_defaults(get()); }
};

/// A brume_tank.
class Tank : public detail::Handle<brume_tank, brume_tank_destroy> {
 public:
  /// brume_tank_create.
  Tank(const Context& context, const brume_tank_params& params)
      : Handle(detail::created<brume_tank>(
            [&](brume_tank** out) { return brume_tank_create(context.get(), &params, out); })) {}

  /// brume_tank_set_lighting.
  void set_lighting(const brume_tank_lighting& lighting) { check(brume_tank_set_lighting(get(), &lighting)); }
  /// brume_shown_tank_defaults.
  brume_shown_tank shown() const { return brume_shown_tank_defaults(get()); }
};

/// brume_vulkan_merge_features.
inline void merge_features(void* chain, brume_feature_storage& storage) {
  check(brume_vulkan_merge_features(chain, &storage));
}

/// A brume_device.
class Device : public detail::Handle<brume_device, brume_device_destroy> {
 public:
  /// brume_device_create.
  Device(const Context& context, const brume_device_params& params)
      : Handle(detail::created<brume_device>(
            [&](brume_device** out) { return brume_device_create(context.get(), &params, out); })) {}

  /// brume_device_memory.
  std::uint64_t memory() const {
    return detail::value_of<std::uint64_t>(
        [&](std::uint64_t* out) { return brume_device_memory(get(), out); });
  }
  /// brume_device_allocated_memory.
  std::uint64_t allocated_memory() const {
    return detail::value_of<std::uint64_t>(
        [&](std::uint64_t* out) { return brume_device_allocated_memory(get(), out); });
  }
  /// brume_device_compile.
  void compile(const brume_renderer_params& renderer = brume_renderer_defaults(),
               const brume_frame_params& frame = brume_frame_defaults()) {
    check(brume_device_compile(get(), &renderer, &frame));
  }
  /// brume_device_set_memory_limit.
  void set_memory_limit(std::uint64_t bytes) { check(brume_device_set_memory_limit(get(), bytes)); }
};

/// An image that a renderer owns.
struct Image {
  VkImage image = VK_NULL_HANDLE;     ///< In VK_IMAGE_LAYOUT_GENERAL.
  VkImageView view = VK_NULL_HANDLE;  ///< A view of the whole image.
};

/// The results of brume_renderer_coarseness.
struct Coarseness {
  std::uint32_t level = 0;        ///< Voxels are 2^level times as wide as the level's voxels.
  bool is_smoke_missing = false;  ///< Smoke out of view has been dropped.
};

/// A brume_renderer.
class Renderer : public detail::Handle<brume_renderer, brume_renderer_destroy> {
 public:
  /// brume_renderer_create.
  Renderer(const Device& device, const brume_renderer_params& params)
      : Handle(detail::created<brume_renderer>(
            [&](brume_renderer** out) { return brume_renderer_create(device.get(), &params, out); })) {}

  /// brume_renderer_resize.
  void resize(std::uint32_t width, std::uint32_t height) {
    check(brume_renderer_resize(get(), width, height));
  }
  /// brume_renderer_set_march_scale.
  void set_march_scale(std::uint32_t march_scale) {
    check(brume_renderer_set_march_scale(get(), march_scale));
  }
  /// brume_renderer_set_lights.
  void set_lights(const std::vector<brume_light>& lights) {
    check(brume_renderer_set_lights(get(), lights.data(), lights.size()));
  }
  /// brume_renderer_set_triangles.
  void set_triangles(const std::vector<brume_point>& points, const std::vector<std::uint32_t>& indices) {
    check(brume_renderer_set_triangles(get(), points.data(), points.size(), indices.data(), indices.size()));
  }
  /// brume_renderer_record. `field` may be null: no smoke, and no level.
  void record(const Field* field, const brume_frame_params& params) {
    check(brume_renderer_record(get(), field ? field->get() : nullptr, &params));
  }
  /// brume_renderer_record_views.
  void record(const Field* field, const std::vector<brume_frame_params>& views) {
    std::vector<const brume_frame_params*> pointers;
    for (const brume_frame_params& view : views) pointers.push_back(&view);
    check(
        brume_renderer_record_views(get(), field ? field->get() : nullptr, pointers.data(), pointers.size()));
  }
  /// brume_renderer_smoke.
  Image smoke() const { return image(brume_renderer_smoke); }
  /// brume_renderer_shadows.
  Image shadows() const { return image(brume_renderer_shadows); }
  /// brume_renderer_motion.
  Image motion() const { return image(brume_renderer_motion); }
  /// brume_renderer_occlusion: another image after each frame.
  Image occlusion() const { return image(brume_renderer_occlusion); }
  /// brume_renderer_coarseness.
  Coarseness coarseness() const {
    std::uint32_t level = 0, is_smoke_missing = 0;
    check(brume_renderer_coarseness(get(), &level, &is_smoke_missing));
    return {level, is_smoke_missing != 0};
  }
  /// brume_renderer_timings.
  std::vector<brume_timing> timings() const {
    return detail::list_of<brume_timing>([&](brume_timing* out, std::size_t capacity, std::size_t* count) {
      return brume_renderer_timings(get(), out, capacity, count);
    });
  }

 private:
  template <typename Read>
  Image image(Read read) const {
    Image made;
    check(read(get(), &made.image, &made.view));
    return made;
  }
};

}  // namespace brume::api

#endif  // BRUME_BRUME_VULKAN_HPP
