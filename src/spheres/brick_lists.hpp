// Which spheres touch each brick of a tank.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "shared/spheres.h"
#include "spheres/tank.hpp"

namespace brume::spheres {

/// Bricks of kSphereBrick^3 voxels, x fastest, those at the high sides cut off by the tank.
struct BrickLists {
  glm::ivec3 bricks{0};                     ///< Along each axis.
  std::vector<shared::SphereBrick> ranges;  ///< Range in `spheres` of each brick.
  std::vector<std::uint32_t> spheres;       ///< Indices of spheres, ascending within each brick.

  std::size_t index(const glm::ivec3& brick) const {
    return (std::size_t(brick.z) * std::size_t(bricks.y) + std::size_t(brick.y)) * std::size_t(bricks.x) +
           std::size_t(brick.x);
  }
};

/// Lists the spheres that touch each brick (shared::sphere_touches). The same for any number of threads.
/// Throws resource_limit where they are more than 2^32 - 1 in all.
BrickLists list_bricks(const Tank& tank);

/// A sphere as shared/spheres.h has it.
inline glm::vec4 packed(const Sphere& sphere) {
  return {sphere.center, sphere.radius};
}

}  // namespace brume::spheres
