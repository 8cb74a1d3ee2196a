// A level that changes while two smokes live in it.
#pragma once

#include "scenario/scenario.hpp"
#include "scenario/voxel_cache.hpp"
#include "tests/render/boxes.hpp"

namespace brume::render {

/// A floor, a wall with a door between two smokes, lights around, one of them a spot, and a sun. Noise 0: the
/// smokes hold still once they have grown. A shot goes through the left one alone.
inline scenario::Scenario two_smokes(float noise) {
  scene::Scene scene;
  scene.meshes.resize(3);
  add_box(scene.meshes[0], {-12, -0.3f, -6}, {12, -0.1f, 6});
  add_box(scene.meshes[0], {-0.1f, -0.1f, -6}, {0.1f, 3, -1});
  add_box(scene.meshes[0], {-0.1f, -0.1f, 1}, {0.1f, 3, 6});
  add_box(scene.meshes[1], glm::vec3(-0.2f), glm::vec3(0.2f));
  add_box(scene.meshes[2], {-0.1f, -0.1f, -1}, {0.1f, 3, 1});
  scene.materials.resize(1);
  scene.objects.push_back({"ground", 0, 0, glm::mat4(1)});
  scene.objects.push_back({"door", 2, 0, glm::mat4(1)});
  scene.grenade = {"grenade", 1, 0, glm::mat4(1), Role::ghost};
  for (const glm::vec3 place :
       {glm::vec3(-9, 2, 3), glm::vec3(-3, 1, -3), glm::vec3(8, 2, 2), glm::vec3(3, 2, -2)}) {
    scene::Light light;
    light.position_world = place;
    light.intensity = glm::vec3(1.5f);
    scene.lights.push_back(light);
  }
  scene.lights[1].kind = scene::LightKind::spot;
  scene.lights[1].direction_world = glm::normalize(glm::vec3(-1, 0, 1));
  scene::Light sun;
  sun.kind = scene::LightKind::directional;
  sun.direction_world = glm::normalize(glm::vec3(0.4f, -1, -0.5f));
  sun.intensity = glm::vec3(0.3f);
  scene.lights.push_back(sun);

  scene::Timeline timeline;
  timeline.sky = {glm::vec3(0.1f), glm::vec3(0.2f), glm::vec3(0.1f), 0};
  timeline.smoke.voxels = 120;
  timeline.smoke.erosion = noise;
  timeline.smokes = {{0, {-6, 1, 0}, {-6, 0.2f, 0}}, {3, {6, 1, 0}, {6, 0.2f, 0}}};
  timeline.shots = {{5, {-10, 1, 0.3f}, {-2, 1, 0.3f}, 0.3f, {0.1f, 0.1f, 2.0f, 0.3f}}};
  timeline.doors = {{9, "door", true, ""}};
  const voxel::GridLayout frame{{50, 12, 26}, 0.5f, {-12.4f, -0.6f, -6.4f}};
  auto voxels = scenario::load_or_voxelize(scene, frame, {}).value_or_throw();
  return {std::move(timeline), std::move(scene), {{0, 3, 11}, {0, 0.5f, 0}, 1.2f}, std::move(voxels)};
}

}  // namespace brume::render
