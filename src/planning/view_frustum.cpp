#include "planning/view_frustum.hpp"

#include <algorithm>

namespace brume::planning {

ViewFrustum::ViewFrustum(const shared::Camera& camera) : eye_world_(camera.eye_world) {
  const auto side = [&](glm::vec3 s) { return glm::normalize(camera.forward - s / glm::dot(s, s)); };
  inward_ = {camera.forward, side(camera.right), side(-camera.right), side(camera.up), side(-camera.up)};
}

bool ViewFrustum::may_intersect(const WorldSphere& sphere, glm::vec3 segment) const {
  const glm::vec3 from_eye = sphere.centre - eye_world_;
  return std::all_of(inward_.begin(), inward_.end(), [&](glm::vec3 inward) {
    return glm::dot(from_eye, inward) + std::max(glm::dot(segment, inward), 0.0f) >= -sphere.radius;
  });
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
