// A hall full of smoke, for tests of what can be seen through it.
#pragma once

#include "tests/render/rooms.hpp"

namespace brume::render {

struct HallSmoke {
  int voxels_per_metre = 4;
  float extinction = 1.5f, erosion = 0.5f;
};

/// A hall with pillars, a door frame, a slatted screen and a fence of thin bars, 140 m^3 of smoke in its
/// middle, shots through it.
inline scenario::Scenario hall(const HallSmoke& smoke = {}) {
  scene::Scene scene;
  scene::Mesh mesh, bars;
  add_box(mesh, {-6, -0.3f, -6}, {6, -0.05f, 6});
  for (const float side : {-1.0f, 1.0f}) {
    add_box(mesh, {side < 0 ? -6.2f : 6, -0.05f, -6}, {side < 0 ? -6 : 6.2f, 4, 6});
    add_box(mesh, {-6, -0.05f, side < 0 ? -6.2f : 6}, {6, 4, side < 0 ? -6 : 6.2f});
    add_box(mesh, {2.2f * side - 0.2f, -0.05f, -0.2f}, {2.2f * side + 0.2f, 4, 0.2f});
  }
  add_box(mesh, {-6, -0.05f, 2.05f}, {-3.3f, 4, 2.2f});
  add_box(mesh, {-2.2f, -0.05f, 2.05f}, {-1, 4, 2.2f});
  for (int i = 0; i < 30; ++i) {
    const float x = 0.1f * static_cast<float>(i);
    add_box(bars, {x, 0, 2.1f}, {x + 0.02f, 2.4f, 2.12f});
    add_box(bars, {0, 0.08f * static_cast<float>(i), -2.1f},
            {3, 0.08f * static_cast<float>(i) + 0.02f, -2.08f});
  }
  scene::Mesh sign;
  add_box(sign, glm::vec3(-0.5f), glm::vec3(0.5f));
  scene.meshes = {mesh, bars, sign};
  scene.materials.resize(2);
  scene.materials[0].base_color = glm::vec3(0.5f);
  scene.materials[1].emission = glm::vec3(4);
  scene.objects = {{"hall", 0, 0, glm::mat4(1)}, {"bars", 1, 0, glm::mat4(1), Role::ghost}};
  scene.grenade = {"sign", 2, 1, glm::mat4(1), Role::ghost};
  for (const glm::vec3 at : {glm::vec3(-4, 3, 4), glm::vec3(3, 2, -4), glm::vec3(0, 3.5f, 0)})
    scene.lights.push_back(scene_light(at, {12, 10, 7}));
  scene.camera = scene::Camera{{0, 1.5f, 5.5f}, {0, 1.5f, 0}, 0.9f};

  scene::Timeline timeline;
  timeline.sky = plain_sky(0, 0.01f);
  const int fine = smoke.voxels_per_metre;
  timeline.smoke.voxels = static_cast<std::uint32_t>(9000 * fine * fine * fine / 64);
  timeline.smoke.extinction = smoke.extinction;
  timeline.smoke.erosion = smoke.erosion;
  timeline.smokes = {{0, {0.5f, 1, 0.5f}, {0.5f, 0.2f, 0.5f}}};
  for (const float x : {-4.0f, -1.0f, 1.5f, 4.0f})
    timeline.shots.push_back({2, {x, 1.5f, 5.5f}, {-0.6f * x, 1.2f, -5}, 0.3f, {.stay = 20}});
  return scenario_of(
      std::move(scene), std::move(timeline),
      {{13 * fine, 9 * fine / 2, 13 * fine}, 1.0f / static_cast<float>(fine), {-6.5f, -0.35f, -6.5f}});
}

}  // namespace brume::render
