// Scenes of one square.
#pragma once

#include "scene/scene.hpp"

namespace brume::reference {

/// A square around the z axis, 2 `half` wide, at `z`, that faces along it; black.
inline scene::Scene square_at(float z, float half) {
  scene::Scene scene;
  scene::Mesh& mesh = scene.meshes.emplace_back();
  for (const glm::vec2 at : {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
    scene::Vertex vertex;
    vertex.position = {half * at.x, half * at.y, z};
    vertex.normal = {0, 0, 1};
    mesh.vertices.push_back(vertex);
  }
  mesh.indices = {0, 1, 2, 0, 2, 3};
  scene::Material material;
  material.base_color = glm::vec3(0);
  scene.materials.push_back(material);
  scene.objects.push_back({"square", 0, 0});
  return scene;
}

/// The same that emits 1.
inline scene::Scene lit_square(float z, float half) {
  scene::Scene scene = square_at(z, half);
  scene.materials[0].emission = glm::vec3(1);
  return scene;
}

}  // namespace brume::reference
