// Scenes of boxes and lights, their scenarios, and the room that most of them show.
#pragma once

#include <utility>
#include <vector>

#include "scenario/scenario.hpp"
#include "scenario/voxel_cache.hpp"
#include "tests/render/boxes.hpp"

namespace brume::render {

using Boxes = std::vector<std::pair<glm::vec3, glm::vec3>>;  ///< By their low and high corners.

inline scene::Light scene_light(const glm::vec3& p_world, const glm::vec3& intensity) {
  scene::Light light;
  light.position_world = p_world;
  light.intensity = intensity;
  return light;
}
inline scene::Light scene_sun(const glm::vec3& direction, float irradiance) {
  scene::Light light = scene_light({}, glm::vec3(irradiance));
  light.kind = scene::LightKind::directional;
  light.direction_world = glm::normalize(direction);
  return light;
}

/// Adds an object of boxes, with a mesh of its own.
inline scene::Object& add_boxes(scene::Scene& scene, const char* name, const Boxes& boxes,
                                std::uint32_t material = 0) {
  scene::Mesh& mesh = scene.meshes.emplace_back();
  for (const auto& [low, high] : boxes) add_box(mesh, low, high);
  return scene.objects.emplace_back(
      scene::Object{name, static_cast<std::uint32_t>(scene.meshes.size() - 1), material});
}
/// Grenades are cubes, of the first material.
inline void set_grenade(scene::Scene& scene, float edge = 0.4f) {
  add_box(scene.meshes.emplace_back(), glm::vec3(-edge / 2), glm::vec3(edge / 2));
  const auto mesh = static_cast<std::uint32_t>(scene.meshes.size() - 1);
  scene.grenade = {"grenade", mesh, 0, glm::mat4(1), Role::ghost};
}
/// A level of boxes in one material. An edge of 0: without grenades.
inline scene::Scene scene_of(const Boxes& boxes, std::vector<scene::Light> lights = {},
                             float grenade_edge = 0.4f) {
  scene::Scene scene;
  scene.materials.resize(1);
  add_boxes(scene, "level", boxes);
  if (grenade_edge > 0) set_grenade(scene, grenade_edge);
  scene.lights = std::move(lights);
  return scene;
}

/// A timeline in a scene, and the voxels of that. Without a camera of the scene: from the origin.
inline scenario::Scenario scenario_of(scene::Scene scene, scene::Timeline timeline,
                                      const voxel::GridLayout& layout) {
  auto voxels = scenario::load_or_voxelize(scene, layout, {}).value_or_throw();
  const scene::Camera camera = scene.camera.value_or(scene::Camera{});
  return {std::move(timeline), std::move(scene), camera, std::move(voxels)};
}

/// A floor, a wall across it at z = -3, and more boxes, before a camera that looks at the wall along -z.
inline scene::Scene room_of(std::vector<scene::Light> lights, const Boxes& more = {}) {
  Boxes boxes{{{-6, -0.3f, -3.2f}, {6, -0.1f, 6}}, {{-6, -0.1f, -3.2f}, {6, 4, -3}}};
  boxes.insert(boxes.end(), more.begin(), more.end());
  scene::Scene scene = scene_of(boxes, std::move(lights));
  scene.camera = scene::Camera{{0, 1.5f, 5.5f}, {0, 1.5f, 0}, 0.9f};
  return scene;
}
/// Its voxels.
constexpr voxel::GridLayout kRoomLayout{{52, 20, 40}, 0.25f, {-6.5f, -0.6f, -3.5f}};

/// A sky of one colour, and no light from it but `ambient`.
inline scene::SkyOptions plain_sky(float radiance, float ambient = 0) {
  return {glm::vec3(radiance), glm::vec3(radiance), glm::vec3(ambient), 0};
}

}  // namespace brume::render
