// What a camera can see of the world, for whoever must decide what a frame needs.
#pragma once

#include <array>

#include "shared/frame.h"

namespace brume::planning {

/// A sphere in the world [m].
struct WorldSphere {
  glm::vec3 centre{0};
  float radius = 0;
};

/// The pyramid before a camera, without end. Its answers err to one side only: what may be seen is never
/// denied.
class ViewFrustum {
 public:
  explicit ViewFrustum(const shared::Camera& camera);

  /// Whether any of a sphere may be in view.
  bool may_intersect(const WorldSphere& sphere) const { return may_intersect(sphere, glm::vec3(0)); }
  /// Whether any of a sphere may be in view somewhere on its way along `way` [m].
  bool may_intersect(const WorldSphere& sphere, glm::vec3 way) const;

 private:
  glm::vec3 eye_world_;
  std::array<glm::vec3, 5> inward_;  // normals of the planes through the eye, unit
};

}  // namespace brume::planning
