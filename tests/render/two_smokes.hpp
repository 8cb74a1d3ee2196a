// A level that changes while two smokes live in it.
#pragma once

#include "tests/render/rooms.hpp"

namespace brume::render {

/// A floor, a wall with a door between two smokes, lights around, one of them a spot, and a sun. Noise 0: the
/// smokes hold still once they have grown. A shot goes through the left one alone.
inline scenario::Scenario two_smokes(float noise) {
  scene::Scene scene = scene_of({{{-12, -0.3f, -6}, {12, -0.1f, 6}},
                                 {{-0.1f, -0.1f, -6}, {0.1f, 3, -1}},
                                 {{-0.1f, -0.1f, 1}, {0.1f, 3, 6}}});
  add_boxes(scene, "door", {{{-0.1f, -0.1f, -1}, {0.1f, 3, 1}}});
  for (const glm::vec3 place :
       {glm::vec3(-9, 2, 3), glm::vec3(-3, 1, -3), glm::vec3(8, 2, 2), glm::vec3(3, 2, -2)})
    scene.lights.push_back(scene_light(place, glm::vec3(1.5f)));
  scene.lights[1].kind = scene::LightKind::spot;
  scene.lights[1].direction_world = glm::normalize(glm::vec3(-1, 0, 1));
  scene.lights.push_back(scene_sun({0.4f, -1, -0.5f}, 0.3f));
  scene.camera = {{0, 3, 11}, {0, 0.5f, 0}, 1.2f};

  scene::Timeline timeline;
  timeline.sky = {glm::vec3(0.1f), glm::vec3(0.2f), glm::vec3(0.1f), 0};
  timeline.smoke.voxels = 120;
  timeline.smoke.erosion = noise;
  timeline.smokes = {{0, {-6, 1, 0}, {-6, 0.2f, 0}}, {3, {6, 1, 0}, {6, 0.2f, 0}}};
  timeline.shots = {{5, {-10, 1, 0.3f}, {-2, 1, 0.3f}, 0.3f, {0.1f, 0.1f, 2.0f, 0.3f}}};
  timeline.doors = {{9, "door", true, ""}};
  return scenario_of(std::move(scene), std::move(timeline), {{50, 12, 26}, 0.5f, {-12.4f, -0.6f, -6.4f}});
}

}  // namespace brume::render
