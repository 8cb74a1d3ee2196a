// What a camera can see of the world, for the decision what a frame requires.
#pragma once

#include <array>

#include "core/box.hpp"
#include "shared/frame.h"

namespace brume::planning {

/// A sphere in the world [m].
struct WorldSphere {
  glm::vec3 centre{0};
  float radius = 0;
};

/// The pyramid before a camera, or the prism before a parallel one, without a far plane. Its tests are
/// conservative: what is visible is never rejected.
class ViewFrustum {
 public:
  explicit ViewFrustum(const shared::Camera& camera);

  /// Whether any of a sphere may be in view.
  bool may_intersect(const WorldSphere& sphere) const { return may_intersect(sphere, glm::vec3(0)); }
  /// Whether any of a sphere may be in view somewhere on a segment from where it is, along `segment` [m].
  bool may_intersect(const WorldSphere& sphere, glm::vec3 segment) const;
  /// From the eye to the nearest point of a sphere; 0 inside [m].
  float distance_to(const WorldSphere& sphere) const;
  /// Whether any of a box [m] may be in view.
  bool may_intersect(const Box<float>& box) const;

 private:
  glm::vec3 eye_world_;
  std::array<glm::vec3, 5> inward_;  // normals of the planes, unit
  std::array<float, 5> behind_;      // how far the eye is in front of them
};

}  // namespace brume::planning
