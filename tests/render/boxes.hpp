// Boxes as meshes, for scenes of tests.
#pragma once

#include "scene/scene.hpp"

namespace brume::render {

/// Adds a box of six sides, twelve triangles, facing outward.
inline void add_box(scene::Mesh& mesh, glm::vec3 low, glm::vec3 high) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const float side : {-1.0f, 1.0f}) {
      glm::vec3 normal(0), u(0), v(0);
      normal[axis] = side;
      u[(axis + 1) % 3] = 1;
      v[(axis + 2) % 3] = side;
      const glm::vec3 centre = 0.5f * (low + high), half = 0.5f * (high - low);
      const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
      for (const glm::vec2 corner :
           {glm::vec2(-1, -1), glm::vec2(1, -1), glm::vec2(1, 1), glm::vec2(-1, 1)}) {
        scene::Vertex vertex;
        vertex.position = centre + half * (normal + corner.x * u + corner.y * v);
        vertex.normal = normal;
        vertex.tangent = glm::vec4(u, 1);
        mesh.vertices.push_back(vertex);
      }
      for (const std::uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) mesh.indices.push_back(first + i);
    }
  }
}

}  // namespace brume::render
