// Tanks for tests: spheres that do not overlap, thrown at random.
#pragma once

#include <random>

#include "spheres/tank.hpp"

namespace brume::spheres {

using Random = std::mt19937;

inline float uniform(Random& random, float low, float high) {
  return low + (high - low) * (static_cast<float>(random() >> 8) * 0x1p-24f);
}

/// Spheres inside of a box that do not overlap, in a jittered grid: one per cell of `cell` voxels, with radii
/// from `least` to half of the cell and any colour. At most half of the shortest axis large.
inline Tank jittered_tank(const glm::uvec3& size, float cell, float least, Random& random) {
  Tank tank;
  tank.size = size;
  const glm::vec3 room(size);
  const glm::ivec3 cells(room / cell);
  for (int z = 0; z < cells.z; ++z)
    for (int y = 0; y < cells.y; ++y)
      for (int x = 0; x < cells.x; ++x) {
        // A little less than fits, so that rounding makes no overlap.
        const float radius = uniform(random, least, 0.499f * cell);
        const float free = 0.499f * cell - radius;
        glm::vec3 center = cell * (glm::vec3(x, y, z) + 0.5f);
        for (int axis = 0; axis < 3; ++axis) center[axis] += uniform(random, -free, free);
        tank.spheres.push_back({center, radius});
        tank.colors.push_back(static_cast<Color>(random()));
      }
  return tank;
}

/// `tries` spheres of radii from `least` to `most` at random places, those that meet one before dropped. Slow
/// beyond a few thousand.
inline Tank thrown_tank(const glm::uvec3& size, int tries, float least, float most, Random& random) {
  Tank tank;
  tank.size = size;
  for (int i = 0; i < tries; ++i) {
    Sphere sphere;
    // Many more small ones.
    const float t = uniform(random, 0, 1);
    sphere.radius = least + (most - least) * t * t * t;
    for (int axis = 0; axis < 3; ++axis)
      sphere.center[axis] = uniform(random, sphere.radius, static_cast<float>(size[axis]) - sphere.radius);
    bool is_free = true;
    for (const Sphere& other : tank.spheres) {
      const glm::vec3 d = other.center - sphere.center;
      const float sum = (other.radius + sphere.radius) * 1.00001f;
      is_free = is_free && glm::dot(d, d) > sum * sum;
    }
    if (!is_free) continue;
    tank.spheres.push_back(sphere);
    tank.colors.push_back(static_cast<Color>(random()));
  }
  return tank;
}

}  // namespace brume::spheres
