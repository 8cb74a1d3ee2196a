#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>

namespace brume::scene {

Box<float> world_bounds(const Scene& scene) {
  Box<float> bounds = kEmptyBox;
  for (const Object& object : scene.objects) {
    for (const Vertex& vertex : scene.meshes[object.mesh].vertices) {
      const glm::vec3 p = glm::vec3(object.world_from_mesh * glm::vec4(vertex.position, 1));
      bounds.low = glm::min(bounds.low, p);
      bounds.high = glm::max(bounds.high, p);
    }
  }
  for (const Sphere& sphere : scene.spheres) {
    bounds.low = glm::min(bounds.low, sphere.centre_world - sphere.radius);
    bounds.high = glm::max(bounds.high, sphere.centre_world + sphere.radius);
  }
  return bounds;
}

Camera default_camera(const Scene& scene) {
  if (scene.camera) return *scene.camera;
  Camera camera;
  const Box<float> bounds = world_bounds(scene);
  if (bounds.empty()) return camera;
  // Fits the bounding sphere into the vertical field of view, so that square images contain it too.
  const float radius = std::max(glm::length(bounds.high - bounds.low) / 2, 0.1f);
  camera.target_world = (bounds.low + bounds.high) / 2.0f;
  camera.position_world = camera.target_world + glm::normalize(glm::vec3(0.8f, 0.6f, 1)) *
                                                    (radius / std::sin(camera.vertical_fov / 2));
  return camera;
}

}  // namespace brume::scene
