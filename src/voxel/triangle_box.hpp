// One triangle against many voxels: what is the same for all voxels is computed once.
//
// The thirteen axes of the separating-axis test fall into the three of the box (the range of candidates), the
// normal (PlaneTest), and nine products of an edge with a box axis. The latter are perpendicular to that
// axis: three edges in each of three projections (EdgeTest), as in Schwarz & Seidel 2010, section 4. An axis
// separates when the intervals of box and triangle on it are disjoint; both ends are looked at, so that
// triangles of no area, whose edges have no inner side, need no special care.
#pragma once

#include <algorithm>
#include <array>
#include <glm/glm.hpp>

namespace brume::voxel {

/// Three corners in voxel space.
using VoxelTriangle = std::array<glm::dvec3, 3>;

/// One edge in the projection along `axis`: u and w are the axes (axis + 1) % 3 and (axis + 2) % 3.
struct EdgeTest {
  double nu = 0, nw = 0;      // The edge's normal in the projection.
  double at_u = 0, at_w = 0;  // The corner where the edge begins.
  double low = 0,
         high = 0;  // What the normal may say of a voxel's low corner when the axis does not separate.

  EdgeTest() = default;
  EdgeTest(const VoxelTriangle& t, unsigned edge, int axis) {
    const int u = (axis + 1) % 3, w = (axis + 2) % 3;
    const glm::dvec3 &p = t[edge], &q = t[(edge + 1) % 3], &r = t[(edge + 2) % 3];
    nu = p[w] - q[w];
    nw = q[u] - p[u];
    at_u = p[u];
    at_w = p[w];
    const double opposite = nu * (r[u] - at_u) + nw * (r[w] - at_w);
    low = std::min(0.0, opposite) - (std::max(nu, 0.0) + std::max(nw, 0.0));
    high = std::max(0.0, opposite) - (std::min(nu, 0.0) + std::min(nw, 0.0));
  }

  /// Whether the axis leaves the voxel with low corner (u, w) joined to the triangle.
  bool joins(double u, double w) const {
    const double value = nu * (u - at_u) + nw * (w - at_w);
    return value >= low && value <= high;
  }
};

/// The plane of the triangle.
struct PlaneTest {
  glm::dvec3 normal{0}, at{0};
  double low = 0, high = 0;

  PlaneTest() = default;
  explicit PlaneTest(const VoxelTriangle& t) : normal(glm::cross(t[1] - t[0], t[2] - t[0])), at(t[0]) {
    const double b = glm::dot(normal, t[1] - at), c = glm::dot(normal, t[2] - at);
    low = std::min({0.0, b, c});
    high = std::max({0.0, b, c});
    for (int axis = 0; axis < 3; ++axis) {
      low -= std::max(normal[axis], 0.0);
      high -= std::min(normal[axis], 0.0);
    }
  }

  bool joins(const glm::dvec3& voxel) const {
    const double value = glm::dot(normal, voxel - at);
    return value >= low && value <= high;
  }
};

/// The ten axes that are not the box's own.
struct TriangleTest {
  PlaneTest plane;
  std::array<std::array<EdgeTest, 3>, 3> edges;  // [axis of the projection][edge]

  explicit TriangleTest(const VoxelTriangle& t) : plane(t) {
    for (int axis = 0; axis < 3; ++axis) edges[static_cast<unsigned>(axis)] = projection(t, axis);
  }

  static std::array<EdgeTest, 3> projection(const VoxelTriangle& t, int axis) {
    return {EdgeTest(t, 0, axis), EdgeTest(t, 1, axis), EdgeTest(t, 2, axis)};
  }

  static bool joins(const std::array<EdgeTest, 3>& projected, double u, double w) {
    return projected[0].joins(u, w) && projected[1].joins(u, w) && projected[2].joins(u, w);
  }
  bool edges_join(int axis, const glm::dvec3& voxel) const {
    return joins(edges[static_cast<unsigned>(axis)], voxel[(axis + 1) % 3], voxel[(axis + 2) % 3]);
  }
  /// Whether none of the ten axes separates. The caller has looked at the box's three.
  bool joins(const glm::dvec3& voxel) const {
    return plane.joins(voxel) && edges_join(0, voxel) && edges_join(1, voxel) && edges_join(2, voxel);
  }
};

}  // namespace brume::voxel
