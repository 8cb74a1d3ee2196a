#include "tests/render/truth_scenes.hpp"

namespace brume::render {
namespace {

scene::Light spot(glm::vec3 position, glm::vec3 at, glm::vec3 intensity) {
  scene::Light light = scene_light(position, intensity);
  light.kind = scene::LightKind::spot;
  light.direction_world = glm::normalize(at - position);
  light.cos_inner = 0.95f;
  light.cos_outer = 0.85f;
  return light;
}

/// The room in a dark material.
scene::Scene room(const Boxes& boxes, std::vector<scene::Light> lights) {
  scene::Scene scene = room_of(std::move(lights), boxes);
  scene.materials[0].base_color = glm::vec3(0.2f);
  return scene;
}

scene::Timeline smoke_at(glm::vec3 place, std::uint32_t voxels) {
  scene::Timeline timeline;
  timeline.sky = plain_sky(0);
  timeline.smoke.voxels = voxels;
  timeline.smoke.extinction = 2;
  timeline.smoke.erosion = 0;
  timeline.smokes = {{0.0, place + glm::vec3(0, 0.5f, 0), place}};
  return timeline;
}

scene::ShotEvent shot(glm::vec3 from, glm::vec3 toward, float radius) {
  scene::ShotEvent event{1.5, from, toward, radius, {.stay = 5}};
  event.flash = 0;
  return event;
}

}  // namespace

std::vector<TruthCase> truth_cases() {
  const glm::vec3 white(60), red(40, 8, 5), blue(6, 12, 40), green(10, 40, 10);
  const scene::Light side = scene_light({-2.2f, 2.6f, 2.2f}, white);
  std::vector<TruthCase> cases;
  const auto add = [&](const char* name, scene::Scene scene, scene::Timeline timeline) -> TruthCase& {
    cases.push_back({name, scenario_of(std::move(scene), std::move(timeline), kRoomLayout)});
    return cases.back();
  };
  add("one light", room({}, {side}), smoke_at({0, 0.2f, 0}, 1500));
  add("many lights",
      room({}, {scene_light({-2.5f, 1, 1}, red), scene_light({2.6f, 1, 1.4f}, blue),
                scene_light({0, 3.5f, -1}, green), spot({1.6f, 3.5f, 2.4f}, {0.3f, 0.5f, 0}, white),
                scene_light({0.2f, 0.8f, 0.9f}, 0.02f * white)}),
      smoke_at({0, 0.2f, 0}, 1500));
  auto pierced = smoke_at({0, 0.2f, 0}, 1800);
  pierced.shots = {shot({-3, 1.2f, 1}, {3, 1, 0.7f}, 0.4f)};
  add("hole", room({}, {scene_light({-3, 1.25f, 1}, 0.7f * white)}), pierced);
  auto riddled = smoke_at({0, 0.2f, 0}, 1800);
  riddled.shots = {shot({0, 1.5f, 5.5f}, {-0.5f, 1, 0}, 0.4f), shot({3, 1.5f, 1}, {-1, 0.8f, 0}, 0.3f)};
  add("two holes", room({}, {side, scene_light({3, 1.5f, 1}, blue)}), riddled);
  add("wall edge",
      room({{{-1.3f, -0.1f, -0.55f}, {0.3f, 2.2f, -0.4f}}},
           {scene_light({-0.4f, 1.9f, -1.6f}, 2.0f * white)}),
      smoke_at({0.4f, 0.2f, 0.6f}, 1500));
  add("doorway",
      room({{{-6, -0.1f, -0.6f}, {-0.6f, 4, -0.45f}},
            {{0.6f, -0.1f, -0.6f}, {6, 4, -0.45f}},
            {{-0.6f, 2.1f, -0.6f}, {0.6f, 4, -0.45f}}},
           {scene_light({0.7f, 1.5f, -2.2f}, 2.0f * white), scene_light({2.5f, 3, 3}, red)}),
      smoke_at({0, 0.2f, 0.6f}, 1500));
  auto blasted = smoke_at({0, 0.2f, 0}, 2400);
  blasted.blasts = {{1.5, {0.6f, 0.8f, 0.9f}}};
  blasted.blasts[0].radius = 1.6f;
  blasted.blasts[0].flash = 0;
  add("blast", room({}, {side}), blasted);
  add("wall along the view",
      room({{{-0.05f, -0.1f, -1}, {0.05f, 2.4f, 1.5f}}},
           {scene_light({-2, 2, 2}, blue), scene_light({2.2f, 1.2f, 2}, red)}),
      smoke_at({0.5f, 0.2f, 0}, 1800));
  riddled.smoke.erosion = 0.5f;
  TruthCase& noisy = add("noise and holes", room({}, {side, scene_light({3, 1.5f, 1}, blue)}), riddled);
  noisy.noisy = true;
  return cases;
}

}  // namespace brume::render
