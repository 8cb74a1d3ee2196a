#include "scene/scene.hpp"

namespace brume::scene {

Bounds world_bounds(const Scene& scene) {
  Bounds bounds;
  for (const Object& object : scene.objects) {
    for (const Vertex& vertex : scene.meshes[object.mesh].vertices) {
      const glm::vec3 p = glm::vec3(object.world_from_mesh * glm::vec4(vertex.position, 1));
      bounds.min = glm::min(bounds.min, p);
      bounds.max = glm::max(bounds.max, p);
    }
  }
  return bounds;
}

}  // namespace brume::scene
