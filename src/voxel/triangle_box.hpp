// Tests one triangle against many voxels exactly; everything independent of the voxel is precomputed.
//
// The thirteen axes of the separating-axis test fall into the three of the box (the range of candidates), the
// normal (PlaneTest), and nine products of an edge with a box axis. The latter are perpendicular to that
// axis: three edges in each of three projections (EdgeTest), as in Schwarz & Seidel 2010, section 4. An axis
// separates when the closed intervals of box and triangle on it are disjoint; testing both ends handles
// degenerate triangles, whose edges have no inner side, without a special case.
//
// Walls often touch voxels exactly, where rounding of doubles would decide. Corners are therefore integers,
// relative to a voxel near the triangle and below 2^57 in magnitude. Differences then fit 58 bits, edge
// functions and the normal fit 118, and the plane equation fits 177.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <glm/glm.hpp>

namespace brume::voxel {

__extension__ typedef __int128 Int128;

/// Three corners in voxel space, and relative to `base` as multiples of 2^-shift voxel, truncated.
/// Coordinates of at least 1/32 of the triangle's extent are exact.
struct VoxelTriangle {
  std::array<glm::dvec3, 3> corners;
  std::array<glm::i64vec3, 3> fixed;
  glm::i64vec3 base{0};
  int shift = 0;

  /// Corners must be below 2^kMaxExponent in magnitude.
  static constexpr int kMaxExponent = 55;

  explicit VoxelTriangle(const std::array<glm::dvec3, 3>& p) : corners(p) {}

  /// Computes the integer members.
  void fix() {
    const glm::dvec3 low = glm::floor(glm::min(glm::min(corners[0], corners[1]), corners[2]));
    const glm::dvec3 extent = glm::max(glm::max(corners[0], corners[1]), corners[2]) - low;
    double limit = 4;
    for (shift = 55; limit < std::max({extent.x, extent.y, extent.z}) + 2; --shift) limit *= 2;
    const auto scale = static_cast<double>(std::int64_t{1} << shift);
    base = glm::i64vec3(low);
    for (unsigned i = 0; i < 3; ++i) fixed[i] = glm::i64vec3((corners[i] - low) * scale);
  }

  /// The low side of a voxel in the triangle's bounds, in the units of `fixed`.
  std::int64_t fixed_voxel(int axis, int voxel) const {
    return (voxel - base[axis]) * (std::int64_t{1} << shift);
  }
};

/// One edge in the projection along `axis`: u and w are the axes (axis + 1) % 3 and (axis + 2) % 3.
struct EdgeTest {
  std::int64_t nu = 0, nw = 0;      // The edge's normal in the projection.
  std::int64_t at_u = 0, at_w = 0;  // The corner where the edge begins.
  Int128 low = 0, high = 0;  // Range of value() at a voxel's low corner when the axis does not separate.

  EdgeTest() = default;
  EdgeTest(const VoxelTriangle& t, unsigned edge, int axis) {
    const int u = (axis + 1) % 3, w = (axis + 2) % 3;
    const glm::i64vec3 &p = t.fixed[edge], &q = t.fixed[(edge + 1) % 3], &r = t.fixed[(edge + 2) % 3];
    nu = p[w] - q[w];
    nw = q[u] - p[u];
    at_u = p[u];
    at_w = p[w];
    const Int128 opposite = value(r[u], r[w]), one = Int128{1} << t.shift;
    low = std::min<Int128>(0, opposite) - (std::max<Int128>(nu, 0) + std::max<Int128>(nw, 0)) * one;
    high = std::max<Int128>(0, opposite) - (std::min<Int128>(nu, 0) + std::min<Int128>(nw, 0)) * one;
  }

  Int128 value(std::int64_t u, std::int64_t w) const {
    return Int128{nu} * (u - at_u) + Int128{nw} * (w - at_w);
  }
  /// Whether the axis fails to separate the triangle from the voxel with low corner (u, w).
  bool joins(std::int64_t u, std::int64_t w) const {
    const Int128 v = value(u, w);
    return v >= low && v <= high;
  }
};

/// The three edges of a projection.
struct ProjectionTest {
  std::array<EdgeTest, 3> edges;

  ProjectionTest() = default;
  ProjectionTest(const VoxelTriangle& t, int axis)
      : edges{EdgeTest(t, 0, axis), EdgeTest(t, 1, axis), EdgeTest(t, 2, axis)} {}
  bool joins(std::int64_t u, std::int64_t w) const {
    return edges[0].joins(u, w) && edges[1].joins(u, w) && edges[2].joins(u, w);
  }
};

/// The plane of the triangle. Decides with doubles where their error allows it.
struct PlaneTest {
  std::array<Int128, 3> fixed_normal{};
  glm::i64vec3 fixed_at{0}, base{0};
  int shift = 0;
  glm::dvec3 normal{0}, at{0};  // The same in voxels.
  double low = 0, high = 0;     // Range of the plane value at a voxel's low corner without separation.
  double max_error = 0;         // Bound of the rounding error of doubles.

  PlaneTest() = default;
  /// `reach`: largest distance, by axis, of a tested voxel's corner from the triangle's first corner.
  PlaneTest(const VoxelTriangle& t, const glm::dvec3& reach)
      : fixed_at(t.fixed[0]), base(t.base), shift(t.shift), at(t.corners[0]) {
    const glm::i64vec3 e = t.fixed[1] - t.fixed[0], f = t.fixed[2] - t.fixed[0];
    const auto scale = static_cast<double>(std::int64_t{1} << shift);
    for (int axis = 0; axis < 3; ++axis) {
      const int u = (axis + 1) % 3, w = (axis + 2) % 3;
      const Int128 n = Int128{e[u]} * f[w] - Int128{e[w]} * f[u];
      fixed_normal[static_cast<unsigned>(axis)] = n;
      normal[axis] = static_cast<double>(n) / (scale * scale);
      low -= std::max(normal[axis], 0.0);
      high -= std::min(normal[axis], 0.0);
      // Rounding, and the truncation of `at`.
      max_error +=
          std::abs(normal[axis]) * (reach[axis] + 1) * 0x1p-48 + std::abs(normal[axis]) * (2 / scale);
    }
  }

  bool joins(const glm::ivec3& voxel) const {
    const double value = glm::dot(normal, glm::dvec3(voxel) - at);
    if (value - low > max_error && high - value > max_error) return true;
    if (value - low < -max_error || high - value < -max_error) return false;
    return exact_sign(voxel, true) >= 0 && exact_sign(voxel, false) <= 0;
  }

  /// The sign of the plane equation at the voxel's corner farthest along the normal, or against it.
  int exact_sign(const glm::ivec3& voxel, bool along) const {
    Int128 high_part = 0, low_part = 0;  // The number is high_part * 2^64 + low_part.
    for (int axis = 0; axis < 3; ++axis) {
      const Int128 n = fixed_normal[static_cast<unsigned>(axis)];
      const std::int64_t corner = voxel[axis] - base[axis] + ((n > 0) == along ? 1 : 0);
      const std::int64_t x = corner * (std::int64_t{1} << shift) - fixed_at[axis];
      high_part += (n >> 64) * x;
      low_part += static_cast<Int128>(static_cast<std::uint64_t>(n)) * x;
    }
    high_part += low_part >> 64;
    const bool has_low_bits = static_cast<std::uint64_t>(low_part) != 0;
    return high_part < 0 ? -1 : high_part > 0 || has_low_bits ? 1 : 0;
  }
};

}  // namespace brume::voxel
