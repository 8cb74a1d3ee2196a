#include "planning/view_frustum.hpp"

#include <algorithm>

namespace brume::planning {

ViewFrustum::ViewFrustum(const shared::Camera& camera) : eye_world_(camera.eye_world) {
  // The plane through the eye that the rays of an edge lie in, `at` along `s`.
  const auto side = [&](const glm::vec3& s, float sign, float shift) {
    const float at = sign + shift;
    return glm::normalize(sign * (at * camera.forward - s / glm::dot(s, s)));
  };
  inward_ = {camera.forward, side(camera.right, 1, camera.shift.x), side(camera.right, -1, camera.shift.x),
             side(camera.up, 1, camera.shift.y), side(camera.up, -1, camera.shift.y)};
}

bool ViewFrustum::may_intersect(const WorldSphere& sphere, glm::vec3 segment) const {
  const glm::vec3 from_eye = sphere.centre - eye_world_;
  return std::all_of(inward_.begin(), inward_.end(), [&](glm::vec3 inward) {
    return glm::dot(from_eye, inward) + std::max(glm::dot(segment, inward), 0.0f) >= -sphere.radius;
  });
}

float ViewFrustum::distance_to(const WorldSphere& sphere) const {
  return std::max(glm::length(sphere.centre - eye_world_) - sphere.radius, 0.0f);
}

bool ViewFrustum::may_intersect(const Box<float>& box) const {
  // For rounding, a part of the distances that the planes are tested at.
  const float margin =
      1e-5f * glm::length(glm::max(glm::abs(box.low - eye_world_), glm::abs(box.high - eye_world_)));
  return std::all_of(inward_.begin(), inward_.end(), [&](glm::vec3 inward) {
    const glm::vec3 farthest = glm::mix(box.low, box.high, glm::greaterThan(inward, glm::vec3(0)));
    return glm::dot(farthest - eye_world_, inward) >= -margin;
  });
}

}  // namespace brume::planning
