// Closed meshes whose triangles face outwards.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "voxel/triangle.hpp"

namespace brume::bake {

using Mesh = std::vector<voxel::Triangle>;

/// A parallelepiped with three edges at one corner; the edges are right-handed.
inline Mesh parallelepiped(glm::vec3 corner, glm::vec3 x, glm::vec3 y, glm::vec3 z) {
  Mesh mesh;
  const std::array<glm::vec3, 3> edges{x, y, z};
  for (std::size_t i = 0; i < 3; ++i) {
    const glm::vec3 u = edges[(i + 1) % 3], v = edges[(i + 2) % 3], far = corner + edges[i];
    mesh.push_back({corner, corner + u + v, corner + u});
    mesh.push_back({corner, corner + v, corner + u + v});
    mesh.push_back({far, far + u, far + u + v});
    mesh.push_back({far, far + u + v, far + v});
  }
  return mesh;
}

/// Each corner is the same number in all triangles.
inline Mesh box_mesh(glm::vec3 low, glm::vec3 high) {
  Mesh mesh = parallelepiped(glm::vec3(0), {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  const auto place = [&](glm::vec3& p) {
    for (int axis = 0; axis < 3; ++axis) p[axis] = p[axis] > 0 ? high[axis] : low[axis];
  };
  for (voxel::Triangle& t : mesh) place(t.a), place(t.b), place(t.c);
  return mesh;
}

/// Of quads between points of a grid that is closed along u; `at(i, j)` must be a single point for j = 0 and
/// j = rings unless the grid is closed along v too.
template <typename At>
Mesh quad_mesh(int segments, int rings, bool closed_v, At at) {
  Mesh mesh;
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < segments; ++i) {
      const int right = (i + 1) % segments, up = closed_v ? (j + 1) % rings : j + 1;
      if (closed_v || j > 0) mesh.push_back({at(i, j), at(right, j), at(right, up)});
      if (closed_v || j + 1 < rings) mesh.push_back({at(i, j), at(right, up), at(i, up)});
    }
  return mesh;
}

/// Corners on a sphere.
inline Mesh sphere_mesh(glm::dvec3 centre, double radius, int segments, int rings) {
  return quad_mesh(segments, rings, false, [=](int i, int j) {
    if (j == 0) return glm::vec3(centre - glm::dvec3(0, 0, radius));
    if (j == rings) return glm::vec3(centre + glm::dvec3(0, 0, radius));
    const double u = 2 * std::numbers::pi * i / segments, v = std::numbers::pi * j / rings;
    const double around = radius * std::sin(v);
    return glm::vec3(centre + glm::dvec3(around * std::cos(u), around * std::sin(u), -radius * std::cos(v)));
  });
}

/// Around the z axis.
inline Mesh torus_mesh(double major, double minor, int segments, int rings) {
  return quad_mesh(segments, rings, true, [=](int i, int j) {
    const double u = 2 * std::numbers::pi * i / segments, v = 2 * std::numbers::pi * j / rings;
    const double around = major + minor * std::cos(v);
    return glm::vec3(around * std::cos(u), around * std::sin(u), minor * std::sin(v));
  });
}

/// A square across z of 2 * count^2 triangles.
inline Mesh sheet_mesh(glm::vec3 low, float edge, int count) {
  Mesh mesh;
  const auto at = [&](int i, int j) {
    return low +
           edge * glm::vec3(static_cast<float>(i), static_cast<float>(j), 0) / static_cast<float>(count);
  };
  for (int j = 0; j < count; ++j)
    for (int i = 0; i < count; ++i) {
      mesh.push_back({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
      mesh.push_back({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
    }
  return mesh;
}

inline Mesh inverted(Mesh mesh) {
  for (voxel::Triangle& t : mesh) std::swap(t.b, t.c);
  return mesh;
}

inline Mesh joined(Mesh a, const Mesh& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// By the divergence theorem.
inline double signed_volume(const Mesh& mesh) {
  double volume = 0;
  for (const voxel::Triangle& t : mesh)
    volume += glm::dot(glm::dvec3(t.a), glm::cross(glm::dvec3(t.b), glm::dvec3(t.c))) / 6;
  return volume;
}

}  // namespace brume::bake
