#include "scenario/first_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/log.hpp"
#include "scenario/first_smoke.hpp"
#include "scene/daylight.hpp"
#include "scene/files/load.hpp"
#include "scene/options.hpp"

namespace brume::scenario {
namespace {

/// Diameter of a ball of the default smoke in the default voxels [m]: the scale of its noise and extinction.
constexpr float kUsualSmoke = 3.8f;
/// Sunlight from behind the default camera, and from its side.
constexpr scene::SunOptions kUsualSun{1.4f, 0.85f};
/// Largest coordinate of a scene, half as large as events may have [m].
constexpr float kFarthestScene = static_cast<float>(scene::kFarthestEvent / 2);
/// Extent below which a scene's ground shrinks no more [m].
constexpr float kSmallestExtent = 0.1f;
/// Voxels across the smoke.
constexpr float kVoxelsAcross = 24;
/// Fraction of the image's width that the smoke covers.
constexpr float kSmokeWidth = 0.22f;

float largest_extent(const Box<float>& bounds) {
  const glm::vec3 extent = bounds.high - bounds.low;
  return std::max({extent.x, extent.y, extent.z});
}

/// Whether a box has no extent along two axes or more.
bool is_line(const Box<float>& box) {
  const glm::vec3 extent = box.high - box.low;
  return int(extent.x > 0) + int(extent.y > 0) + int(extent.z > 0) < 2;
}

float chosen_scale(const scene::Scene& scene, const std::filesystem::path& path,
                   const FirstViewOptions& options) {
  if (options.scale) return *options.scale;
  const Box<float> bounds = scene::world_bounds(scene);
  const float extent = bounds.empty() ? 0 : largest_extent(bounds);
  const float scale = fitting_scale(extent, path);
  if (scale != 1) {
    char message[160];
    std::snprintf(message, sizeof message, ": %g units wide; scaled by %g to %g m: give --scale to choose",
                  static_cast<double>(extent), static_cast<double>(scale),
                  static_cast<double>(extent * scale));
    log_warning(path.string() + message);
  }
  return scale;
}

/// The middle of a scene that lies too far away to throw smoke at, in whole units of the file.
glm::vec3 chosen_origin(const scene::Scene& scene, const std::filesystem::path& path, float scale) {
  const Box<float> bounds = scene::world_bounds(scene);
  if (bounds.empty()) return glm::vec3(0);
  const glm::vec3 corner = glm::max(glm::abs(bounds.low), glm::abs(bounds.high)) * scale;
  const float farthest = std::max({corner.x, corner.y, corner.z});
  if (!(farthest > kFarthestScene) || !std::isfinite(farthest)) return glm::vec3(0);
  const glm::vec3 middle = glm::round(0.5f * (bounds.low + bounds.high));
  char message[160];
  std::snprintf(message, sizeof message, ": %.4g m from its origin, which is moved to %.9g, %.9g, %.9g",
                static_cast<double>(farthest), static_cast<double>(middle.x), static_cast<double>(middle.y),
                static_cast<double>(middle.z));
  log_warning(path.string() + message);
  return middle;
}

constexpr glm::vec3 kGroundColor{0.34f, 0.33f, 0.31f};

/// A plane to the horizon.
void add_ground(scene::Scene& scene, float height) {
  const Box<float> bounds = scene::world_bounds(scene);
  const glm::vec3 middle = bounds.empty() ? glm::vec3(0) : 0.5f * (bounds.low + bounds.high);
  const float reach = 1000 * (bounds.empty() ? 1 : std::max(largest_extent(bounds), kSmallestExtent));
  scene::Mesh mesh;
  mesh.name = "ground";
  for (const glm::vec2 corner : {glm::vec2(-1, 1), glm::vec2(1, 1), glm::vec2(1, -1), glm::vec2(-1, -1)}) {
    scene::Vertex vertex;
    vertex.position = {middle.x + reach * corner.x, height, middle.z + reach * corner.y};
    mesh.vertices.push_back(vertex);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  scene::Material material;
  material.name = "ground";
  material.base_color = kGroundColor;
  material.roughness = 0.95f;
  scene.meshes.push_back(std::move(mesh));
  scene.materials.push_back(material);
  scene::Object ground;
  ground.name = "ground";
  ground.mesh = static_cast<std::uint32_t>(scene.meshes.size() - 1);
  ground.material = static_cast<std::uint32_t>(scene.materials.size() - 1);
  ground.backdrop = true;
  scene.objects.push_back(ground);
}

/// Just below a scene that is to be moved and scaled, under a floor that is the lowest part; none for an
/// empty one.
std::optional<float> ground_below(const scene::Scene& scene, const scene::Timeline& timeline) {
  const Box<float> bounds = scene::world_bounds(scene);
  if (bounds.empty()) return std::nullopt;
  return timeline.scale * (bounds.low.y - timeline.origin.y) -
         1e-3f * std::max(timeline.scale * largest_extent(bounds), kSmallestExtent);
}

bool is_sun(const scene::Light& light) {
  return light.kind == scene::LightKind::directional;
}

scene::Light sunlight(const scene::SunOptions& sun) {
  scene::Light light;
  light.kind = scene::LightKind::directional;
  const float flat = std::cos(sun.elevation);
  light.direction_world =
      -glm::vec3(flat * std::sin(sun.azimuth), std::sin(sun.elevation), flat * std::cos(sun.azimuth));
  light.intensity = sun.irradiance;
  return light;
}

float luminance(const glm::vec3& color) {
  return glm::dot(color, glm::vec3(0.2126f, 0.7152f, 0.0722f));
}

/// Irradiance of a scene's brightest sun; 0: it has none.
float sun_level(const scene::Scene& scene) {
  float most = 0;
  for (const scene::Light& light : scene.lights)
    if (is_sun(light)) most = std::max(most, luminance(light.intensity));
  return most;
}

/// Irradiance by the brightest of its other lights half-way from the middle of the scene to its sides.
float light_level(const scene::Scene& scene) {
  const Box<float> bounds = scene::world_bounds(scene);
  const float distance = bounds.empty() ? 1 : std::max(0.25f * largest_extent(bounds), kSmallestExtent);
  float most = 0;
  for (const scene::Light& light : scene.lights)
    if (!is_sun(light)) most = std::max(most, luminance(light.intensity));
  return most / (distance * distance);
}

void scale_sky(scene::SkyOptions& sky, float factor) {
  constexpr float kMost = 1000;  // what the options allow
  for (glm::vec3* color : {&sky.zenith, &sky.horizon, &sky.ambient})
    *color = glm::min(*color * factor, glm::vec3(kMost));
}

/// A sun where one is given or nothing else lights the scene; a sky that matches, as bright as it is beside
/// the usual sun or light: with exposure measured, a scene looks alike whatever the unit of its lights is.
/// Returns how bright its lights are relative to the usual ones, > 0.
float choose_light(scene::Timeline& timeline, const scene::Scene& scene,
                   const std::optional<scene::SunOptions>& sun) {
  timeline.sun = sun;
  if (!sun && scene.lights.empty()) timeline.sun = kUsualSun;
  if (timeline.sun) scene::dim_sky(timeline.sky, timeline.sun->elevation);
  if (timeline.sun) return 1;
  scene::SkyOptions& sky = timeline.sky;
  // A clear sky gives about a fifth of what the sun does.
  if (const float level = sun_level(scene); level > 0) {
    scale_sky(sky, 0.5f * level / luminance(kUsualSun.irradiance));
    return level / luminance(kUsualSun.irradiance);
  }
  sky.zenith = {0.03f, 0.05f, 0.12f};
  sky.horizon = {0.16f, 0.14f, 0.15f};
  sky.ambient = {0.04f, 0.05f, 0.075f};
  constexpr float kUsualLight = 4;  // [W/m^2]
  const float level = light_level(scene) / kUsualLight;
  if (!(level > 0)) return 1;
  scale_sky(sky, level);
  return level;
}

/// Diameter of smoke that covers its fraction of the image's width where it is [m].
float smoke_size(const scene::Camera& camera, glm::vec3 place, const FirstViewOptions& options) {
  if (options.smoke_size) return *options.smoke_size;
  const float distance = glm::length(place - camera.position_world);
  return kSmokeWidth * 2 * distance * std::tan(camera.vertical_fov / 2) * options.aspect;
}

void size_smoke(scene::Timeline& timeline, float diameter, const Box<float>& bounds,
                const FirstViewOptions& options) {
  const float least = std::max(0.015625f, bounds.empty() ? 0 : largest_extent(bounds) / 1000);
  timeline.grid.voxel = options.voxel.value_or(std::clamp(diameter / kVoxelsAcross, least, 64.0f));
  const float across = diameter / timeline.grid.voxel;
  const float ball = std::numbers::pi_v<float> / 6 * across * across * across;
  timeline.smoke.voxels = static_cast<std::uint32_t>(std::clamp(ball, 50.0f, 1e6f));
  // It looks like the usual smoke enlarged.
  const float scale = diameter / kUsualSmoke;
  timeline.smoke.extinction = std::clamp(timeline.smoke.extinction / scale, 0.01f, 100.0f);
  timeline.smoke.noise_size = std::clamp(timeline.smoke.noise_size * scale, 0.05f, 100.0f);
  timeline.smoke.swirl = std::min(timeline.smoke.swirl * scale, 10.0f);
  timeline.smoke.rise = std::min(timeline.smoke.rise * scale, 10.0f);
  timeline.smoke.hole_rim = std::min(timeline.smoke.hole_rim * scale, 10.0f);
  timeline.smoke.albedo = glm::vec3(0.99f);
}

/// The default camera for a scene and its smokes of this diameter [m].
scene::Camera camera_with_smoke(scene::Scene& scene, const std::vector<scene::SmokeEvent>& smokes,
                                float diameter, float aspect) {
  const std::size_t spheres = scene.spheres.size();
  for (const scene::SmokeEvent& smoke : smokes)
    scene.spheres.push_back(
        {smoke.at_world + glm::vec3(0, 0.25f * diameter, 0), 0.5f * diameter, scene::kNone});
  const scene::Camera camera = scene::default_camera(scene, aspect);
  scene.spheres.resize(spheres);
  return camera;
}

}  // namespace

float fitting_scale(float extent, const std::filesystem::path& file) {
  const std::string suffix = scene::lower_extension(file);
  const float least = suffix == ".gltf" || suffix == ".glb" ? 0.25f : 1;
  float scale = 1;
  if (!(extent > 0) || !std::isfinite(extent)) return scale;
  while (extent * scale > 4000) scale *= extent * scale > 400000 ? 0.001f : 0.1f;
  while (extent * scale < least) scale *= 10;
  return scale;
}

void scale_scene(scene::Scene& scene, float factor) {
  if (factor == 1) return;
  const glm::mat4 larger(glm::vec4(factor, 0, 0, 0), glm::vec4(0, factor, 0, 0), glm::vec4(0, 0, factor, 0),
                         glm::vec4(0, 0, 0, 1));
  for (scene::Object& object : scene.objects) object.world_from_mesh = larger * object.world_from_mesh;
  for (scene::Decal& decal : scene.decals) decal.world_from_decal = larger * decal.world_from_decal;
  for (scene::Emitter& emitter : scene.emitters)
    emitter.world_from_emitter = larger * emitter.world_from_emitter;
  for (scene::Sphere& sphere : scene.spheres) {
    sphere.centre_world *= factor;
    sphere.radius *= factor;
  }
  for (scene::Light& light : scene.lights) {
    light.position_world *= factor;
    // Irradiance falls with the square of the distance.
    if (light.kind != scene::LightKind::directional) light.intensity *= factor * factor;
  }
  if (scene.camera) {
    scene.camera->position_world *= factor;
    scene.camera->target_world *= factor;
  }
}

void move_scene(scene::Scene& scene, glm::vec3 by) {
  if (by == glm::vec3(0)) return;
  const auto move = [by](glm::mat4& matrix) { matrix[3] += glm::vec4(by, 0); };
  for (scene::Object& object : scene.objects) move(object.world_from_mesh);
  for (scene::Decal& decal : scene.decals) move(decal.world_from_decal);
  for (scene::Emitter& emitter : scene.emitters) move(emitter.world_from_emitter);
  for (scene::Sphere& sphere : scene.spheres) sphere.centre_world += by;
  for (scene::Light& light : scene.lights) light.position_world += by;
  if (scene.camera) {
    scene.camera->position_world += by;
    scene.camera->target_world += by;
  }
}

void apply_level_options(const scene::Timeline& timeline, scene::Scene& scene) {
  move_scene(scene, -timeline.origin);
  scale_scene(scene, timeline.scale);
  if (timeline.ground) add_ground(scene, *timeline.ground);
  if (timeline.sun) std::erase_if(scene.lights, is_sun);
  if (timeline.sun || scene.lights.empty())
    scene.lights.push_back(sunlight(timeline.sun.value_or(scene::SunOptions{})));
  // A picture that is brightened by more than 2 EV would show where lights end.
  const float brightened = std::exp2(std::max(timeline.exposure - 2, 0.0f));
  for (scene::Light& light : scene.lights) light.least = scene::Light{}.least / brightened;
}

scene::Timeline prepare_first_view(const std::filesystem::path& path, scene::Scene& scene,
                                   const FirstViewOptions& options) {
  scene::Timeline timeline;
  timeline.scene = path;

  // The scene itself.
  timeline.scale = chosen_scale(scene, path, options);
  timeline.origin = chosen_origin(scene, path, timeline.scale);
  const float light = choose_light(timeline, scene, options.sun);
  // Until it is measured, the lights alone decide the exposure.
  timeline.exposure = std::clamp(-std::log2(light), -20.0f, 20.0f);
  scene::replace_given(timeline, options.picture);
  if (!scene.camera && options.has_ground) timeline.ground = ground_below(scene, timeline);
  if (timeline.bounces > 0 && scene.objects.empty())
    log_warning(path.string() + ": bounces change nothing without a level");
  // Volumes are lit from below by the ground, where nothing else is there.
  if (timeline.ground && scene.objects.empty()) timeline.sky.bounce = luminance(kGroundColor);
  apply_level_options(timeline, scene);
  const Box<float> bounds = scene::world_bounds(scene);
  if (!bounds.empty() && is_line(bounds))
    log_warning(path.string() + ": nothing to see: none of its triangles has an area");
  scene::Camera camera = scene::default_camera(scene, options.aspect);

  // Its smoke.
  const bool is_fitted = !scene.camera && !options.camera;
  timeline.smokes = options.smokes;
  if (is_fitted) camera = camera_with_smoke(scene, timeline.smokes, 0, options.aspect);
  const SmokeView view{options.camera.value_or(camera), options.aspect, !is_fitted,
                       !is_fitted && !options.camera};
  const float diameter = smoke_size(view.camera, subject_point(scene, view.camera), options);
  Box<float> extent = bounds;
  for (const scene::SmokeEvent& smoke : timeline.smokes)
    extent = united(extent, {smoke.at_world, smoke.at_world});
  size_smoke(timeline, diameter, extent, options);
  if (timeline.smokes.empty() && options.has_smoke) {
    const glm::vec3 place = choose_smoke_place(scene, view, diameter);
    timeline.smokes.push_back({0, place, place});
  }
  if (is_fitted) camera = camera_with_smoke(scene, timeline.smokes, diameter, options.aspect);
  scene.camera = camera;
  return timeline;
}

}  // namespace brume::scenario
