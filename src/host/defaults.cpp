#include <brume/brume_vulkan.h>

#include "api/defaults.hpp"

namespace brume::api {

template <>
brume_volume_params defaults() {
  brume_volume_params params{};
  params.struct_size = sizeof(brume_volume_params);
  params.frame_rate = 24.0f;
  return params;
}

template <>
brume_decal_params defaults() {
  brume_decal_params params{};
  params.struct_size = sizeof(brume_decal_params);
  params.low.x = params.low.y = params.low.z = -1.0f;
  params.high.x = params.high.y = params.high.z = 1.0f;
  return params;
}

template <>
brume_tank_params defaults() {
  brume_tank_params params{};
  params.struct_size = sizeof(brume_tank_params);
  params.size[0] = params.size[1] = params.size[2] = 1;
  params.voxel = 0.005f;
  return params;
}

template <>
brume_tank_lighting defaults() {
  brume_tank_lighting lighting{};
  lighting.struct_size = sizeof(brume_tank_lighting);
  lighting.ambient[0] = lighting.ambient[1] = lighting.ambient[2] = 0.6f;
  lighting.bounces = 2;
  lighting.fog_color[0] = 0.02f;
  lighting.fog_color[1] = 0.05f;
  lighting.fog_color[2] = 0.08f;
  lighting.glass_radii.x = lighting.glass_radii.y = lighting.glass_radii.z = 0.5f;
  return lighting;
}

template <>
brume_device_params defaults() {
  brume_device_params params{};
  params.struct_size = sizeof(brume_device_params);
  return params;
}

template <>
brume_renderer_params defaults() {
  brume_renderer_params params{};
  params.struct_size = sizeof(brume_renderer_params);
  params.width = 1280;
  params.height = 720;
  params.march_scale = 1;
  return params;
}

template <>
brume_frame_params defaults() {
  brume_frame_params params{};
  params.struct_size = sizeof(brume_frame_params);
  params.camera.forward.z = -1.0f;
  params.camera.up.y = 1.0f;
  params.camera.vertical_fov = 1.0f;
  params.depth.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  params.depth.near_plane = 0.1f;
  params.depth.far_plane = 1000.0f;
  params.picture.exposure = 1.0f;
  params.look.albedo[0] = params.look.albedo[1] = params.look.albedo[2] = 0.92f;
  params.look.anisotropy = 0.2f;
  params.look.multiple_scattering = 1.0f;
  params.look.erosion = 0.5f;
  params.look.noise_size = 1.5f;
  params.look.hole_rim = 0.06f;
  params.look.swirl = 0.2f;
  params.look.rise = 0.12f;
  params.ambient[0] = 0.25f;
  params.ambient[1] = 0.29f;
  params.ambient[2] = 0.35f;
  params.ambient_indoors = 0.2f;
  params.normals.layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
  return params;
}

}  // namespace brume::api

namespace brume::host {
namespace {

brume_shown_volume shown_volume_of(const brume_volume* volume) {
  brume_shown_volume shown{};
  shown.volume = volume;
  shown.x_axis.x = shown.y_axis.y = shown.z_axis.z = 1.0f;
  shown.extinction = 1.0f;
  shown.albedo[0] = shown.albedo[1] = shown.albedo[2] = 0.9f;
  shown.anisotropy = 0.2f;
  shown.multiple_scattering = 1.0f;
  shown.emission = 1.0f;
  shown.kelvin = 1000.0f;
  return shown;
}

brume_shown_decal shown_decal_of(const brume_decal* decal) {
  brume_shown_decal shown{};
  shown.decal = decal;
  shown.x_axis.x = shown.y_axis.y = shown.z_axis.z = 1.0f;
  shown.strength = 1.0f;
  shown.gamma = 1.0f;
  shown.correction = 1.0f;
  shown.falloff = 1.0f;
  shown.fade = 0.05f;
  shown.scatter = 0.5f;
  return shown;
}

brume_shown_tank shown_tank_of(const brume_tank* tank) {
  brume_shown_tank shown{};
  shown.tank = tank;
  shown.x_axis.x = shown.y_axis.y = shown.z_axis.z = 1.0f;
  shown.view = BRUME_TANK_SPHERES;
  shown.samples = 1;
  return shown;
}

}  // namespace
}  // namespace brume::host

using namespace brume::api;
using namespace brume::host;

extern "C" {

brume_result brume_volume_params_init(brume_volume_params* params, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, params, struct_size);
}

brume_result brume_shown_volume_init(brume_shown_volume* shown, const brume_volume* volume) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call&) { required(shown, "shown") = shown_volume_of(volume); });
}

brume_result brume_decal_params_init(brume_decal_params* params, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, params, struct_size);
}

brume_result brume_shown_decal_init(brume_shown_decal* shown, const brume_decal* decal) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call&) { required(shown, "shown") = shown_decal_of(decal); });
}

brume_result brume_tank_params_init(brume_tank_params* params, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, params, struct_size);
}

brume_result brume_tank_lighting_init(brume_tank_lighting* lighting, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, lighting, struct_size);
}

brume_result brume_shown_tank_init(brume_shown_tank* shown, const brume_tank* tank) BRUME_NOEXCEPT {
  return Call(__func__).run([&](Call&) { required(shown, "shown") = shown_tank_of(tank); });
}

brume_result brume_device_params_init(brume_device_params* params, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, params, struct_size);
}

brume_result brume_renderer_params_init(brume_renderer_params* params, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, params, struct_size);
}

brume_result brume_frame_params_init(brume_frame_params* params, uint32_t struct_size) BRUME_NOEXCEPT {
  return write_defaults(__func__, params, struct_size);
}

}  // extern "C"
