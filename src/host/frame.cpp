#include "host/frame.hpp"

#include <cmath>
#include <string>

#include "api/ranges.hpp"
#include "planning/smoke_look.hpp"

namespace brume::host {
namespace {

using api::refuse;
using api::require;

constexpr std::size_t kMostLights = 1024;
/// Bricks of smoke to begin with, 8 x 8 x 8 voxels each: 16 MiB in all images.
constexpr std::uint32_t kReservedBricks = 512;

glm::vec3 unit(const brume_point& direction, const char* name) {
  const glm::dvec3 v(vec3_of(direction));
  const double length = glm::length(v);
  if (!(length > 1e-12 && length < 1e30)) refuse(std::string("`") + name + "` must be finite and not 0");
  return glm::vec3(v / length);
}

std::optional<scene::Frustum> to_frustum(const brume_frustum& given, bool parallel) {
  const bool is_empty = given.left == 0 && given.right == 0 && given.down == 0 && given.up == 0;
  require(!(is_empty && parallel), "`frustum` must be set where `parallel` is 1");
  if (is_empty) return std::nullopt;
  const float most = parallel ? kMostMetres : 1000;
  require(given.left >= -most && given.left < given.right && given.right <= most,
          parallel ? "`frustum.left` must be below `frustum.right`, both within 16384"
                   : "`frustum.left` must be below `frustum.right`, both within 1000");
  require(given.down >= -most && given.down < given.up && given.up <= most,
          parallel ? "`frustum.down` must be below `frustum.up`, both within 16384"
                   : "`frustum.down` must be below `frustum.up`, both within 1000");
  return scene::Frustum{given.left, given.right, given.down, given.up};
}

planning::ViewSample to_sample(const brume_camera& camera) {
  require(is_within(camera.jitter_x, -1, 1) && is_within(camera.jitter_y, -1, 1),
          "`camera.jitter_x` and `jitter_y` must be from -1 to 1");
  return {{camera.jitter_x, camera.jitter_y}};
}

scene::Camera to_camera(const brume_camera& camera, const brume_frustum& frustum, bool parallel) {
  scene::Camera made;
  made.position_world = position(camera.position, "camera.position");
  // Far away, for the direction's precision far from the origin.
  const glm::vec3 forward = unit(camera.forward, "camera.forward");
  made.target_world = made.position_world + 4096.0f * forward;
  made.up_world = unit(camera.up, "camera.up");
  require(glm::length(glm::cross(forward, made.up_world)) > 1e-3f,
          "`camera.up` must not be along `camera.forward`");
  made.frustum = to_frustum(frustum, parallel);
  // A wider range than in timelines: the host draws with this angle in any case.
  require(made.frustum || (camera.vertical_fov > 0 && camera.vertical_fov < 3.1415f),
          "`camera.vertical_fov` must be above 0 and below pi");
  made.vertical_fov = camera.vertical_fov;
  return made;
}

planning::View::Previous to_previous(const brume_frame_params& params) {
  try {
    return {to_camera(params.previous_camera, params.previous_frustum, params.parallel != 0),
            to_sample(params.previous_camera)};
  } catch (const api::CallFailure& failure) {
    api::fail(failure.result, "of the previous view, " + failure.message);
  }
}

scene::SmokeOptions to_options(const brume_smoke_look& look, float extinction) {
  scene::SmokeOptions options;
  options.albedo = vec3_of(look.albedo);
  options.anisotropy = look.anisotropy;
  options.multiple_scattering = look.multiple_scattering;
  options.erosion = look.erosion;
  options.noise_size = look.noise_size;
  options.hole_rim = look.hole_rim;
  options.swirl = look.swirl;
  options.rise = look.rise;
  scene::visit_smoke_options(options, api::RangeCheck("`look."));
  // After the checks, because the extinction of a field has a wider range than in timelines.
  options.extinction = extinction;
  return options;
}

void add_lights(const brume_frame_params& params, std::vector<shared::Light>& lights) {
  require(params.light_count <= planning::kMaxFlashes, "at most 64 lights of a frame");
  if (params.light_count > 0) api::required(params.lights, "lights");
  for (std::size_t i = 0; i < params.light_count; ++i) {
    const scene::Light light = scene_light(params.lights[i], i);
    if (light.kind == scene::LightKind::directional)
      refuse("light " + std::to_string(i) + " of a frame must not be a sun");
    const float brightest = std::max({light.intensity.r, light.intensity.g, light.intensity.b});
    lights.push_back({light.position_world, shared::light_range(brightest), light.intensity,
                      static_cast<std::uint32_t>(light.kind), light.direction_world, light.cos_inner,
                      light.cos_outer, shared::kShadowByVoxels, 0, 0});
  }
}

void add_triangles(const HostArray<brume_point>& points, const HostArray<std::uint32_t>& indices,
                   scene::Mesh& mesh) {
  require(indices.count % 3 == 0, "`index_count` must be a multiple of 3");
  require(points.count < 1u << 28 && indices.count < 1u << 30, "at most 2^28 points and 2^30 indices");
  if (indices.count == 0) return;
  api::required(points.elements, "points");
  api::required(indices.elements, "indices");
  mesh.vertices.resize(points.count);
  for (std::size_t i = 0; i < points.count; ++i)
    mesh.vertices[i].position = position(points.elements[i], "points");
  mesh.indices.assign(indices.elements, indices.elements + indices.count);
  for (const std::uint32_t index : mesh.indices)
    if (index >= points.count) refuse("an index is " + std::to_string(index) + ", beyond the last point");
}

bool can_be_sampled(VkImageLayout layout) {
  return layout == VK_IMAGE_LAYOUT_GENERAL || layout == VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL ||
         layout == VK_IMAGE_LAYOUT_READ_ONLY_OPTIMAL;
}

bool depth_can_be_sampled(VkImageLayout layout) {
  if (can_be_sampled(layout)) return true;
  switch (layout) {
    case VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_OPTIMAL:
    case VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL:
    case VK_IMAGE_LAYOUT_DEPTH_READ_ONLY_STENCIL_ATTACHMENT_OPTIMAL:
      return true;
    default:
      return false;
  }
}

/// A factor in [low, high]; 0 counts as 1.
float scale_of(float given, float low, float high, const char* expected) {
  if (given == 0) return 1;
  require(is_within(given, low, high), expected);
  return given;
}

planning::Quality quality_of(const brume_quality& given) {
  planning::Quality quality;
  quality.step_scale =
      scale_of(given.step_scale, 0.25f, 16, "`quality.step_scale` must be from 0.25 to 16, or 0");
  quality.resolve_error_scale = scale_of(given.resolve_error_scale, 0.25f, 16,
                                         "`quality.resolve_error_scale` must be from 0.25 to 16, or 0");
  quality.fine_shadows = given.skip_fine_shadows == 0;
  quality.light_update_fraction = scale_of(given.light_update_fraction, 1 / 16.0f, 1,
                                           "`quality.light_update_fraction` must be from 1/16 to 1, or 0");
  quality.indirect_update_fraction =
      scale_of(given.bounce_update_fraction, 1 / 16.0f, 1,
               "`quality.bounce_update_fraction` must be from 1/16 to 1, or 0");
  quality.volume_upload_bytes = given.volume_upload_bytes;
  return quality;
}

void show_smoke(const brume_frame_params& params, const api::SmokeField& field, planning::FrameInput& input) {
  require(is_within(params.detail_reduction, 0, 1), "`detail_reduction` must be from 0 to 1");
  scene::SmokeOptions options = to_options(params.look, field.extinction());
  options.detail = 1 - params.detail_reduction;
  const smoke::Field& smoke = field.smoke();
  input.level.voxels = {&smoke.solids().smoke, smoke.state().edits, &smoke.solids().sight};
  input.smoke.volume = &smoke.volume();
  input.smoke.state = &smoke.state();
  input.smoke.holes = smoke.holes();
  input.smoke.look = planning::smoke_look(options, smoke.layout().voxel_size);
}

}  // namespace

bool is_within(float value, float low, float high) {
  return value >= low && value <= high;
}
bool is_within(glm::vec3 v, float low, float high) {
  return is_within(v.x, low, high) && is_within(v.y, low, high) && is_within(v.z, low, high);
}
glm::vec3 vec3_of(const brume_point& p) {
  return {p.x, p.y, p.z};
}
glm::vec3 vec3_of(const float (&c)[3]) {
  return {c[0], c[1], c[2]};
}

bool spans_space(const glm::dvec3& x, const glm::dvec3& y, const glm::dvec3& z) {
  const double lengths = glm::length(x) * glm::length(y) * glm::length(z);
  // False for NaN.
  return lengths > 1e-18 && lengths < 1e18 && std::abs(glm::dot(x, glm::cross(y, z))) > 1e-9 * lengths;
}

glm::vec3 position(const brume_point& p, const char* name) {
  const glm::vec3 v = vec3_of(p);
  if (!is_within(v, -kMostMetres, kMostMetres))
    refuse(std::string("`") + name + "` must be finite and within 16384 m of the world's origin");
  return v;
}

scene::Light scene_light(const brume_light& light, std::size_t number) {
  const std::string name = "light " + std::to_string(number);
  scene::Light made;
  if (light.kind > BRUME_LIGHT_SUN) refuse(name + " must be of a brume_light_kind");
  made.kind = static_cast<scene::LightKind>(light.kind);
  if (light.kind != BRUME_LIGHT_SUN) made.position_world = position(light.position, "light.position");
  if (light.kind != BRUME_LIGHT_POINT) made.direction_world = unit(light.direction, "light.direction");
  made.intensity = vec3_of(light.intensity);
  if (!is_within(made.intensity, 0, 1e12f)) refuse(name + " must have an intensity from 0 to 10^12");
  if (light.kind != BRUME_LIGHT_SPOT) return made;
  if (!(light.inner_angle >= 0 && light.inner_angle < light.outer_angle && light.outer_angle <= 3.1416f))
    refuse(name + " must have angles 0 <= inner < outer <= pi");
  made.cos_inner = std::cos(light.inner_angle);
  made.cos_outer = std::cos(light.outer_angle);
  return made;
}

std::vector<scene::Light> scene_lights(const brume_light* lights, std::size_t count) {
  require(count <= kMostLights, "at most 1024 lights");
  if (count > 0) api::required(lights, "lights");
  std::vector<scene::Light> made;
  for (std::size_t i = 0; i < count; ++i) made.push_back(scene_light(lights[i], i));
  return made;
}

scene::Scene scene_of_triangles(const HostArray<brume_point>& points,
                                const HostArray<std::uint32_t>& indices) {
  scene::Scene scene;
  scene.meshes.resize(1);
  add_triangles(points, indices, scene.meshes[0]);
  scene.materials.resize(1);
  if (!scene.meshes[0].indices.empty()) scene.objects.push_back({"level", 0, 0, glm::mat4(1)});
  return scene;
}

scene::Scene to_scene(const brume_renderer_params& params) {
  scene::Scene scene =
      scene_of_triangles({params.points, params.point_count}, {params.indices, params.index_count});
  scene.lights = scene_lights(params.lights, params.light_count);
  return scene;
}

glm::uvec2 checked_size(std::uint32_t width, std::uint32_t height) {
  require(width >= 1 && width <= kMostPixels && height >= 1 && height <= kMostPixels,
          "`width` and `height` must be from 1 to 16384");
  return {width, height};
}

std::uint32_t checked_scale(std::uint32_t march_scale) {
  require(march_scale == 1 || march_scale == 2 || march_scale == 4, "`march_scale` must be 1, 2 or 4");
  return march_scale;
}

render::RendererOptions renderer_options(const brume_renderer_params& params) {
  render::RendererOptions options;
  options.size_px = checked_size(params.width, params.height);
  options.smoke.march_scale = checked_scale(params.march_scale);
  options.smoke.prepare_all = params.prepare_all != 0;
  options.smoke.temporal = params.temporal != 0;
  options.smoke.reserved_bricks = kReservedBricks;
  options.smoke.memory_follows_view = true;
  options.media_alone = true;
  options.motion = options.smoke.record_entries = params.motion != 0;
  return options;
}

passes::HostDepthRange depth_range(const brume_frame_params& params) {
  const brume_depth& depth = params.depth;
  require(depth.view != VK_NULL_HANDLE, "`depth.view` is null");
  require(depth_can_be_sampled(depth.layout), "`depth.layout` must be one in which depth can be sampled");
  require(depth.near_plane > 0 && depth.near_plane < kMostMetres,
          "`depth.near_plane` must be above 0 and below 16384");
  require(depth.far_plane > depth.near_plane, "`depth.far_plane` must be above near_plane");
  require(params.parallel == 0 || std::isfinite(depth.far_plane),
          "`depth.far_plane` must be finite where `parallel` is 1");
  return {depth.near_plane, depth.far_plane, depth.reversed != 0, params.parallel != 0,
          params.depth_has_samples != 0};
}

passes::HostNormals host_normals(const brume_normals& normals) {
  require(normals.encoding <= BRUME_NORMALS_OCTAHEDRAL_UNSIGNED,
          "`normals.encoding` must be a brume_normal_encoding");
  require(normals.view == VK_NULL_HANDLE || can_be_sampled(normals.layout),
          "`normals.layout` must be one in which normals can be sampled");
  return {nullptr, normals.encoding, normals.in_view_space != 0, normals.alpha_receives != 0};
}

void set_frame_input(const brume_frame_params& params, const api::SmokeField* field,
                     planning::FrameInput& input) {
  auto slices = std::move(input.slices);
  input.clear();
  input.slices = std::move(slices);

  // The view and the time.
  if (params.parallel) input.view.projection = planning::Projection::parallel;
  input.view.camera = to_camera(params.camera, params.frustum, params.parallel != 0);
  input.view.size_px = {params.part.width, params.part.height};
  require(params.view < BRUME_MAX_VIEWS, "`view` must be below 4");
  input.view.index = params.view;
  input.view.sample = to_sample(params.camera);
  input.view.frame_index = params.jitter_index;
  input.view.continues = params.continues_previous != 0;
  if (params.has_previous) input.view.previous = to_previous(params);
  require(params.seconds >= 0 && params.seconds <= 1e7, "`seconds` must be from 0 to 10^7");

  // Light.
  input.environment.sky.ambient = vec3_of(params.ambient);
  // A thousand times more than in timelines: each host has its own unit of radiance.
  require(is_within(input.environment.sky.ambient, 0, 1e6f), "`ambient` must be from 0 to 10^6");
  const auto sky = [](auto& o, auto& v) { scene::visit_sky_options(o, v); };
  api::require_range(scene::info_of<scene::SkyOptions>("bounce", sky), params.ambient_indoors,
                     "`ambient_indoors`");
  input.environment.sky.bounce = params.ambient_indoors;
  input.environment.bounces = params.bounces;
  scene::visit_bounce_options(input.environment, api::RangeCheck("`"));
  add_lights(params, input.environment.flashes);

  // Quality, and the exposure, below which light is too dark to be seen.
  input.quality = quality_of(params.quality);
  if (params.picture.view != VK_NULL_HANDLE) input.view.exposure = params.picture.exposure;

  // Smoke.
  if (field) show_smoke(params, *field, input);
  input.smoke.time = static_cast<float>(params.seconds);
}

}  // namespace brume::host
