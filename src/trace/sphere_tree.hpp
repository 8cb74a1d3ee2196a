// Balls as Embree traces them.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <string>

#include "core/error.hpp"
#include "spheres/tank.hpp"
#include "trace/embree_scene.hpp"

namespace brume::trace {

/// Finds which spheres a ray meets; exactly where is left to the caller, since a tree has floats.
class SphereTree {
 public:
  static constexpr std::uint32_t kNone = UINT32_MAX;

  /// Builds the tree, once, of a copy of the spheres. Fails as EmbreeScene.
  Result<void> build(const std::string& job, std::span<const spheres::Sphere> spheres);

  struct Hit {
    std::uint32_t sphere = kNone;  ///< Index; kNone: nothing is hit.
    float t = 0;
  };
  /// The first surface on a ray (direction: unit) in [from, to], from outside or inside, but not the surface
  /// of `skip`.
  Hit next(const glm::vec3& origin, const glm::vec3& direction, float from, float to,
           std::uint32_t skip) const;

 private:
  EmbreeScene scene_;
};

}  // namespace brume::trace
