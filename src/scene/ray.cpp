#include "scene/ray.hpp"

#include <cmath>
#include <limits>

namespace brume::scene {
namespace {

/// The distance along the ray in units of its direction's length; infinity for a miss.
double hit_distance(glm::dvec3 origin, glm::dvec3 direction, const glm::dvec3 (&corner)[3]) {
  constexpr double kMiss = std::numeric_limits<double>::infinity();
  const glm::dvec3 ab = corner[1] - corner[0], ac = corner[2] - corner[0];
  const glm::dvec3 p = glm::cross(direction, ac);
  const double determinant = glm::dot(ab, p);
  if (determinant == 0) return kMiss;
  const glm::dvec3 from_corner = origin - corner[0];
  const double u = glm::dot(from_corner, p) / determinant;
  const glm::dvec3 q = glm::cross(from_corner, ab);
  const double v = glm::dot(direction, q) / determinant;
  const double distance = glm::dot(ac, q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && distance > 0 ? distance : kMiss;
}

}  // namespace

std::optional<glm::vec3> first_hit(const Scene& scene, glm::vec3 origin_world, glm::vec3 direction_world) {
  const glm::dvec3 origin(origin_world), direction(direction_world);
  double nearest = std::numeric_limits<double>::infinity();
  for (const Object& object : scene.objects) {
    if (!stops_smoke(object.role)) continue;
    const glm::dmat4 world_from_mesh(object.world_from_mesh);
    const Mesh& mesh = scene.meshes[object.mesh];
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
      glm::dvec3 corner[3];
      for (std::size_t k = 0; k < 3; ++k) {
        const glm::vec3 position = mesh.vertices[mesh.indices[i + k]].position;
        corner[k] = glm::dvec3(world_from_mesh * glm::dvec4(glm::dvec3(position), 1));
      }
      nearest = std::min(nearest, hit_distance(origin, direction, corner));
    }
  }
  if (!std::isfinite(nearest)) return std::nullopt;
  return glm::vec3(origin + direction * nearest);
}

}  // namespace brume::scene
