// Parameters of the host, checked, in the form that the renderer takes.
#pragma once

#include <brume/brume_vulkan.h>

#include <array>
#include <cstddef>

#include "api/smoke_field.hpp"
#include "render/renderer.hpp"

namespace brume::api {

// The sizes of 0.1 and 0.2; `timings` lies in what was padding then. The members of brume_frame_params had
// another order then: it has no earlier size.
template <>
inline constexpr std::array kEarlierSizes<brume_device_params>{
    std::uint32_t{offsetof(brume_device_params, memory_user)},
    std::uint32_t{offsetof(brume_device_params, enabled_features)}};
template <>
inline constexpr std::array kEarlierSizes<brume_renderer_params>{
    std::uint32_t{offsetof(brume_renderer_params, prepare_all)},
    std::uint32_t{offsetof(brume_renderer_params, motion)}};
template <>
inline constexpr std::array kEarlierSizes<brume_volume_params>{
    std::uint32_t{offsetof(brume_volume_params, no_processes)}};
template <>
inline constexpr std::array kEarlierSizes<brume_frame_params>{
    std::uint32_t{offsetof(brume_frame_params, part)}};

}  // namespace brume::api

namespace brume::host {

constexpr std::uint32_t kMostPixels = 16384;  ///< Along each side of a picture.
constexpr float kMostMetres = 16384;          ///< From the world's origin, along each axis.

/// False for what is not a number.
bool is_within(float value, float low, float high);
bool is_within(glm::vec3 v, float low, float high);
glm::vec3 vec3_of(const brume_point& p);
glm::vec3 vec3_of(const float (&c)[3]);
/// Whether axes are finite and span space.
bool spans_space(const glm::dvec3& x_axis, const glm::dvec3& y_axis, const glm::dvec3& z_axis);

/// All throw a CallFailure for what brume_vulkan.h does not allow.
glm::vec3 position(const brume_point& p, const char* name);
scene::Light scene_light(const brume_light& light, std::size_t number);
std::vector<scene::Light> scene_lights(const brume_light* lights, std::size_t count);

/// An array of a caller.
template <typename T>
struct HostArray {
  const T* elements;
  std::size_t count;
};
/// A scene of triangles, without lights.
scene::Scene scene_of_triangles(const HostArray<brume_point>& points,
                                const HostArray<std::uint32_t>& indices);
scene::Scene to_scene(const brume_renderer_params& params);
glm::uvec2 checked_size(std::uint32_t width, std::uint32_t height);
std::uint32_t checked_scale(std::uint32_t march_scale);
/// Without masks.
render::RendererOptions renderer_options(const brume_renderer_params& params);
passes::HostDepthRange depth_range(const brume_frame_params& params);
/// Normals for decals; the caller sets the image, where there is a view.
passes::HostNormals host_normals(const brume_normals& normals);
/// Sets all of `input`, without volumes and decals; its lists keep their memory, and `slices` remain. What it
/// points to is the field's. `field`: null: no smoke.
void set_frame_input(const brume_frame_params& params, const api::SmokeField* field,
                     planning::FrameInput& input);

}  // namespace brume::host
