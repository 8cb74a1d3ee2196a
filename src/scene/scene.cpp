#include "scene/scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace brume::scene {

float focus_distance(const Camera& camera) {
  if (camera.lens.focus > 0) return camera.lens.focus;
  return glm::distance(camera.position_world, camera.target_world);
}

Box<float> level_bounds(const Scene& scene) {
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
  return bounds;
}

Box<float> world_bounds(const Scene& scene) {
  Box<float> bounds = level_bounds(scene);
  for (const Volume& volume : scene.volumes) bounds = united(bounds, volume.bounds_world);
  return bounds;
}

namespace {

/// Calls visit(point in the world) for all corners of objects but backdrops and of boxes around spheres.
template <typename Visit>
void for_each_corner(const Scene& scene, Visit visit) {
  for (const Object& object : scene.objects) {
    if (object.backdrop) continue;
    for (const Vertex& vertex : scene.meshes[object.mesh].vertices)
      visit(glm::vec3(object.world_from_mesh * glm::vec4(vertex.position, 1)));
  }
  for (const Sphere& sphere : scene.spheres)
    for (int corner = 0; corner < 8; ++corner)
      visit(sphere.centre_world +
            sphere.radius * (2.0f * glm::vec3(corner & 1, corner >> 1 & 1, corner >> 2) - 1.0f));
}

/// The same, also for materials of the cores of volumes.
template <typename Visit>
void for_each_point(const Scene& scene, Visit visit) {
  for_each_corner(scene, visit);
  for (const Volume& volume : scene.volumes)
    for (int corner = 0; corner < 8; ++corner)
      visit(glm::mix(volume.core_world.low, volume.core_world.high,
                     glm::bvec3(corner & 1, corner & 2, corner & 4)));
}

/// The largest cosine of the angles between two [radians].
double largest_cosine(double from, double to) {
  const double low = std::min(from, to), high = std::max(from, to);
  constexpr double kTurn = 2 * std::numbers::pi;
  if (std::floor(high / kTurn) >= std::ceil(low / kTurn)) return 1;
  return std::max(std::cos(low), std::cos(high));
}

}  // namespace

Camera default_camera(const Scene& scene, float aspect) {
  if (scene.camera) return *scene.camera;
  Camera camera;
  camera.vertical_fov = 0.85f;
  // What of volumes is framed may lie far from the middle of their bounds.
  Box<float> bounds = level_bounds(scene);
  for (const Volume& volume : scene.volumes) bounds = united(bounds, volume.core_world);
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

Camera orbited(const Camera& camera, glm::vec3 centre_world, double radians) {
  if (radians == 0) return camera;
  const double c = std::cos(radians), s = std::sin(radians);
  const auto rotated = [&](glm::vec3 p) {
    const glm::dvec3 centre(centre_world), off = glm::dvec3(p) - centre;
    return glm::vec3(centre + glm::dvec3(c * off.x + s * off.z, off.y, c * off.z - s * off.x));
  };
  Camera turned = camera;
  turned.position_world = rotated(camera.position_world);
  turned.target_world = rotated(camera.target_world);
  return turned;
}

std::vector<glm::vec3> level_corners(const Scene& scene) {
  std::vector<glm::vec3> corners;
  for_each_corner(scene, [&](glm::vec3 p) { corners.push_back(p); });
  return corners;
}

Camera fitted_to_orbit(std::span<const glm::vec3> points_world, const Camera& camera, glm::vec3 centre_world,
                       double radians, float aspect) {
  const glm::dvec3 centre(centre_world), target(camera.target_world);
  const glm::dvec3 toward_eye = glm::dvec3(camera.position_world) - target;
  const double distance = glm::length(toward_eye);
  const glm::dvec3 back = toward_eye / distance;
  const glm::dvec3 right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), back)),
                   up = glm::cross(back, right);
  const double vertical = std::tan(double{camera.vertical_fov} / 2), horizontal = vertical * double{aspect};

  // A point that is off the target by q is inside where |x| <= k (distance - z), as in default_camera: where
  // the distance is at least the product of q with each of four vectors. Circling the centre rotates the
  // point the other way, so that the horizontal part of a product is a cosine.
  const std::array limits{back + right / horizontal, back - right / horizontal, back + up / vertical,
                          back - up / vertical};
  std::array<double, 4> around{-1e30, -1e30, -1e30, -1e30};  // distances with the centre as target
  for (const glm::vec3 p : points_world) {
    const glm::dvec3 off = glm::dvec3(p) - centre;
    const double reach = std::hypot(off.x, off.z), azimuth = std::atan2(off.x, off.z);
    for (std::size_t i = 0; i < limits.size(); ++i) {
      const double begin = azimuth - std::atan2(limits[i].x, limits[i].z);
      const double across = reach * std::hypot(limits[i].x, limits[i].z);
      around[i] = std::max(around[i], across * largest_cosine(begin, begin - radians) + off.y * limits[i].y);
    }
  }
  double required = 0;
  for (std::size_t i = 0; i < limits.size(); ++i)
    required = std::max(required, around[i] + glm::dot(limits[i], centre - target));
  constexpr double kRounding = 1e-4;
  if (required <= distance * (1 + kRounding)) return camera;

  // The target that requires the least distance.
  const glm::dvec3 aim = centre + 0.5 * (around[0] - around[1]) * horizontal * right +
                         0.5 * (around[2] - around[3]) * vertical * up;
  const double least = 0.5 * std::max(around[0] + around[1], around[2] + around[3]);
  Camera fitted = camera;
  fitted.position_world = glm::vec3(aim + least * back);
  fitted.target_world = glm::vec3(aim);
  return fitted;
}

}  // namespace brume::scene
