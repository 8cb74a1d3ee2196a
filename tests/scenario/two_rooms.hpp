// Two rooms with a door in between, created in memory.
#pragma once

#include <string>

#include "scenario/scenario.hpp"

namespace brume::scenario {

inline void add_box(scene::Mesh& mesh, glm::vec3 low, glm::vec3 high) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const bool at_high : {false, true}) {
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (int corner = 0; corner < 4; ++corner) {
        glm::vec3 p;
        p[axis] = at_high ? high[axis] : low[axis];
        p[(axis + 1) % 3] = corner & 1 ? high[(axis + 1) % 3] : low[(axis + 1) % 3];
        p[(axis + 2) % 3] = corner & 2 ? high[(axis + 2) % 3] : low[(axis + 2) % 3];
        mesh.vertices.emplace_back().position = p;
      }
      for (const std::uint32_t i : {0u, 1u, 3u, 0u, 3u, 2u}) mesh.indices.push_back(first + i);
    }
  }
}

inline void add_object(scene::Scene& scene, const std::string& name, glm::vec3 low, glm::vec3 high) {
  add_box(scene.meshes.emplace_back(), low, high);
  scene::Object object;
  object.name = name;
  object.mesh = static_cast<std::uint32_t>(scene.meshes.size() - 1);
  scene.objects.push_back(object);
}

/// Two rooms of 4 x 3 x 4 m side by side along x, a wall between them with a doorway of 1 x 2 m at its foot,
/// and a door of two leaves in it.
inline Scenario two_rooms() {
  scene::Scene scene;
  const float t = 0.1f;  // half of a wall
  add_object(scene, "floor", {-4 - t, -t, -2 - t}, {4 + t, t, 2 + t});
  add_object(scene, "ceiling", {-4 - t, 3 - t, -2 - t}, {4 + t, 3 + t, 2 + t});
  add_object(scene, "west", {-4 - t, 0, -2}, {-4 + t, 3, 2});
  add_object(scene, "east", {4 - t, 0, -2}, {4 + t, 3, 2});
  add_object(scene, "south", {-4, 0, -2 - t}, {4, 3, -2 + t});
  add_object(scene, "north", {-4, 0, 2 - t}, {4, 3, 2 + t});
  add_object(scene, "middle", {-t, 0, -2}, {t, 3, -0.5f});
  add_object(scene, "middle", {-t, 0, 0.5f}, {t, 3, 2});
  add_object(scene, "middle", {-t, 2, -0.5f}, {t, 3, 0.5f});
  add_object(scene, "door", {-0.02f, 0, -0.5f}, {0.02f, 2, 0});
  add_object(scene, "door", {-0.02f, 0, 0}, {0.02f, 2, 0.5f});
  add_object(scene, "poster", {-3, 1, -1.8f}, {-2, 2, -1.75f});
  scene.objects.back().role = Role::ghost;
  scene::Timeline timeline;
  timeline.smoke.voxels = 6000;
  timeline.smokes = {{0.0, {-3, 1.5f, 0}, {-2, 0, 0}}};
  const voxel::GridLayout layout{{44, 20, 28}, 0.2f, glm::vec3(-4.33f, -0.43f, -2.83f)};
  Voxels voxels = load_or_voxelize(scene, layout, {}).value_or_throw();
  return {std::move(timeline), std::move(scene), {}, std::move(voxels)};
}

}  // namespace brume::scenario
