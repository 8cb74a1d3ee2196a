#include "planning/view_frustum.hpp"

#include <algorithm>

namespace brume::planning {

ViewFrustum::ViewFrustum(const shared::Camera& camera) : eye_world_(camera.eye_world) {
  // The plane that the rays of an edge lie in, `at` along `s`.
  const auto set_side = [&](std::size_t i, const glm::vec3& s, float sign, float shift) {
    const float at = sign + shift;
    inward_[i] = glm::normalize(sign * ((1 - camera.parallel) * at * camera.forward - s / glm::dot(s, s)));
    behind_[i] = camera.parallel * sign * at * glm::length(s);
  };
  inward_[0] = camera.forward;
  behind_[0] = 0;
  set_side(1, camera.right, 1, camera.shift.x);
  set_side(2, camera.right, -1, camera.shift.x);
  set_side(3, camera.up, 1, camera.shift.y);
  set_side(4, camera.up, -1, camera.shift.y);
}

bool ViewFrustum::may_intersect(const WorldSphere& sphere, glm::vec3 segment) const {
  const glm::vec3 from_eye = sphere.centre - eye_world_;
  for (std::size_t i = 0; i < inward_.size(); ++i) {
    const float nearest = glm::dot(from_eye, inward_[i]) + std::max(glm::dot(segment, inward_[i]), 0.0f);
    if (!(nearest + behind_[i] >= -sphere.radius)) return false;
  }
  return true;
}

float ViewFrustum::distance_to(const WorldSphere& sphere) const {
  return std::max(glm::length(sphere.centre - eye_world_) - sphere.radius, 0.0f);
}

bool ViewFrustum::may_intersect(const Box<float>& box) const {
  // For rounding, a part of the distances that the planes are tested at.
  const float margin =
      1e-5f * glm::length(glm::max(glm::abs(box.low - eye_world_), glm::abs(box.high - eye_world_)));
  for (std::size_t i = 0; i < inward_.size(); ++i) {
    const glm::vec3 farthest = glm::mix(box.low, box.high, glm::greaterThan(inward_[i], glm::vec3(0)));
    if (!(glm::dot(farthest - eye_world_, inward_[i]) + behind_[i] >= -margin)) return false;
  }
  return true;
}

}  // namespace brume::planning
