#include "scene/scene.hpp"

#include <algorithm>
#include <cmath>

namespace brume::scene {

Box<float> world_bounds(const Scene& scene) {
  Box<float> bounds = kEmptyBox;
  for (const Object& object : scene.objects) {
    if (object.backdrop) continue;
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
  for (const Volume& volume : scene.volumes) bounds = united(bounds, volume.bounds_world);
  return bounds;
}

namespace {

/// Calls visit(point in the world) for all corners of objects but backdrops, of boxes around spheres, and of
/// the cores of volumes.
template <typename Visit>
void for_each_point(const Scene& scene, Visit visit) {
  for (const Object& object : scene.objects) {
    if (object.backdrop) continue;
    for (const Vertex& vertex : scene.meshes[object.mesh].vertices)
      visit(glm::vec3(object.world_from_mesh * glm::vec4(vertex.position, 1)));
  }
  for (const Sphere& sphere : scene.spheres)
    for (int corner = 0; corner < 8; ++corner)
      visit(sphere.centre_world +
            sphere.radius * (2.0f * glm::vec3(corner & 1, corner >> 1 & 1, corner >> 2) - 1.0f));
  for (const Volume& volume : scene.volumes)
    for (int corner = 0; corner < 8; ++corner)
      visit(glm::mix(volume.core_world.low, volume.core_world.high,
                     glm::bvec3(corner & 1, corner & 2, corner & 4)));
}

}  // namespace

Camera default_camera(const Scene& scene, float aspect) {
  if (scene.camera) return *scene.camera;
  Camera camera;
  camera.vertical_fov = 0.85f;
  const Box<float> bounds = world_bounds(scene);
  if (bounds.empty()) return camera;
  const float radius = std::max(glm::length(bounds.high - bounds.low) / 2, 0.05f);
  const glm::vec3 middle = (bounds.low + bounds.high) / 2.0f;
  const glm::vec3 back = glm::normalize(glm::vec3(0.8f, 0.52f, 1));
  const glm::vec3 right = glm::normalize(glm::cross({0, 1, 0}, back)), up = glm::cross(back, right);

  // A point at (x, y) of the image's plane and z towards the eye is inside where |x - centre| <= k (distance
  // - z), k the tangent of the fitted angle. So the largest z +- x / k give the nearest distance and its
  // centre.
  const float vertical = 0.8f * std::tan(camera.vertical_fov / 2), horizontal = vertical * aspect;
  glm::vec2 plus(-1e30f), minus(-1e30f);
  float nearest = -1e30f;
  for_each_point(scene, [&](glm::vec3 p) {
    const glm::vec3 off = p - middle;
    const glm::vec2 scaled(glm::dot(off, right) / horizontal, glm::dot(off, up) / vertical);
    const float z = glm::dot(off, back);
    plus = glm::max(plus, z + scaled);
    minus = glm::max(minus, z - scaled);
    nearest = std::max(nearest, z);
  });
  const glm::vec2 centre = 0.5f * (plus - minus) * glm::vec2(horizontal, vertical);
  const glm::vec2 distances = 0.5f * (plus + minus);
  const float distance = std::max({distances.x, distances.y, nearest + 0.2f * radius});
  camera.target_world = middle + centre.x * right + centre.y * up;
  camera.position_world = camera.target_world + distance * back;
  return camera;
}

}  // namespace brume::scene
