// Triangle against one voxel by brute force: thirteen axes, all corners projected, in double precision.
// Independent of src/voxel but for the types.
#pragma once

#include <algorithm>
#include <array>
#include <glm/glm.hpp>
#include <limits>
#include <vector>

#include "voxel/bit_grid.hpp"
#include "voxel/triangle.hpp"

namespace brume::reference {

inline bool separated_along(const glm::dvec3& axis, const std::array<glm::dvec3, 3>& triangle,
                            const glm::dvec3& box_low, double slack = 0) {
  constexpr double kInf = std::numeric_limits<double>::infinity();
  double t0 = kInf, t1 = -kInf, b0 = kInf, b1 = -kInf;
  for (const glm::dvec3& p : triangle) {
    const double d = glm::dot(axis, p - box_low);
    t0 = std::min(t0, d);
    t1 = std::max(t1, d);
  }
  for (int i = 0; i < 8; ++i) {
    const double d = glm::dot(axis, glm::dvec3(i & 1, i >> 1 & 1, i >> 2));
    b0 = std::min(b0, d);
    b1 = std::max(b1, d);
  }
  return t1 < b0 - slack || b1 < t0 - slack;
}

/// Whether the closed triangle and the closed box [low, low + 1] share a point. `slack` times the
/// rounding error on the axes that are not those of the box counts as touching (above 0) or as apart (below
/// 0).
inline bool touches(const std::array<glm::dvec3, 3>& t, const glm::dvec3& low, double slack = 0) {
  const glm::dvec3 edges[3] = {t[1] - t[0], t[2] - t[1], t[0] - t[2]};
  const glm::dvec3 box_axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  double reach = 1;
  for (const glm::dvec3& p : t) reach = std::max(reach, glm::length(p - low));
  const double rounding = slack * 64 * std::numeric_limits<double>::epsilon() * reach * reach;
  for (const glm::dvec3& axis : box_axes) {
    if (separated_along(axis, t, low)) return false;
    for (const glm::dvec3& edge : edges)
      if (separated_along(glm::cross(axis, edge), t, low, rounding)) return false;
  }
  return !separated_along(glm::cross(edges[0], edges[1]), t, low, rounding * reach);
}

/// One flag per voxel, x fastest: every triangle against every voxel.
inline std::vector<bool> brute_force_voxels(const std::vector<voxel::Triangle>& triangles,
                                            const voxel::GridLayout& layout, double slack = 0) {
  const auto to_voxel = [&](glm::vec3 p) {
    return (glm::dvec3(p) - glm::dvec3(layout.origin_world)) / double{layout.voxel_size};
  };
  std::vector<bool> solid;
  for (int z = 0; z < layout.size.z; ++z)
    for (int y = 0; y < layout.size.y; ++y)
      for (int x = 0; x < layout.size.x; ++x)
        solid.push_back(std::any_of(triangles.begin(), triangles.end(), [&](const voxel::Triangle& t) {
          return touches({to_voxel(t.a), to_voxel(t.b), to_voxel(t.c)}, glm::dvec3(x, y, z), slack);
        }));
  return solid;
}

}  // namespace brume::reference
