// What every packed tank fulfils.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "spheres/tank.hpp"

namespace brume::spheres {

/// Fails unless every sphere is inside and no two overlap: all pairs, by a grid of cells as wide as the
/// largest sphere, in double.
inline void expect_packed(const Tank& tank) {
  ASSERT_EQ(tank.colors.size(), tank.spheres.size());
  double largest = 0;
  for (const Sphere& sphere : tank.spheres) {
    largest = std::max(largest, double{sphere.radius});
    for (int axis = 0; axis < 3; ++axis) {
      ASSERT_GE(double{sphere.center[axis]}, double{sphere.radius});
      ASSERT_LE(double{sphere.center[axis]}, tank.size[axis] - double{sphere.radius});
    }
    ASSERT_GT(sphere.radius, 0);
  }
  if (tank.spheres.empty()) return;
  const double edge = std::max(2 * largest, 1.0);
  const glm::ivec3 cells = glm::ivec3(glm::dvec3(tank.size) / edge) + 1;
  std::vector<std::vector<std::uint32_t>> lists(std::size_t(cells.x) * std::size_t(cells.y) *
                                                std::size_t(cells.z));
  const auto list_at = [&](const glm::ivec3& at) -> std::vector<std::uint32_t>& {
    return lists[std::size_t(at.x + cells.x * (at.y + cells.y * at.z))];
  };
  for (std::uint32_t i = 0; i < tank.spheres.size(); ++i) {
    const Sphere& a = tank.spheres[i];
    const glm::ivec3 cell(glm::dvec3(a.center) / edge);
    const glm::ivec3 low = glm::max(cell - 1, 0), high = glm::min(cell + 1, cells - 1);
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x)
          for (const std::uint32_t j : list_at({x, y, z})) {
            const Sphere& b = tank.spheres[j];
            ASSERT_GE(glm::distance(glm::dvec3(a.center), glm::dvec3(b.center)),
                      double{a.radius} + double{b.radius})
                << i << " and " << j;
          }
    list_at(cell).push_back(i);
  }
}

}  // namespace brume::spheres
