// The volume of a closed mesh in one voxel: the sum, signed, of the tetrahedra from one point to each
// triangle, each clipped as a convex polyhedron by the six planes of the voxel. In long double.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <span>
#include <utility>
#include <vector>

#include "core/box.hpp"
#include "voxel/triangle.hpp"

namespace brume::reference {

using LongVec = glm::vec<3, long double>;
using Face = std::vector<LongVec>;

/// The corners of a convex planar face in order around it.
inline Face around(Face corners, int axis) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  LongVec middle(0);
  for (const LongVec& p : corners) middle += p / static_cast<long double>(corners.size());
  const auto angle = [&](const LongVec& p) { return std::atan2(p[v] - middle[v], p[u] - middle[u]); };
  std::sort(corners.begin(), corners.end(),
            [&](const LongVec& p, const LongVec& q) { return angle(p) < angle(q); });
  return corners;
}

/// Whether a face has an area that matters; corners that occur twice leave faces that are segments.
inline bool has_area(const Face& face) {
  LongVec area(0);
  for (std::size_t i = 2; i < face.size(); ++i) area += glm::cross(face[i - 1] - face[0], face[i] - face[0]);
  return glm::length(area) > 1e-15L;
}

/// The part of a convex polyhedron where sign * p[axis] <= sign * plane.
inline std::vector<Face> half(const std::vector<Face>& faces, int axis, long double plane, long double sign) {
  std::vector<Face> parts;
  Face cap;
  bool has_cap = false;  // A face lies in the plane.
  for (const Face& face : faces) {
    Face part;
    bool flat = true;
    for (std::size_t i = 0; i < face.size(); ++i) {
      const LongVec &a = face[i], &b = face[(i + 1) % face.size()];
      const long double da = sign * (a[axis] - plane), db = sign * (b[axis] - plane);
      flat = flat && da == 0;
      if (da <= 0) part.push_back(a);
      if (da == 0) cap.push_back(a);
      if (da * db < 0) {
        LongVec at = a + da / (da - db) * (b - a);
        at[axis] = plane;
        part.push_back(at);
        cap.push_back(at);
      }
    }
    has_cap = has_cap || flat;
    if (has_area(part)) parts.push_back(std::move(part));
  }
  if (has_cap || cap.empty()) return parts;
  cap = around(std::move(cap), axis);
  if (has_area(cap)) parts.push_back(std::move(cap));
  return parts;
}

/// Of a convex polyhedron: the cones from its middle to its faces.
inline long double convex_volume(const std::vector<Face>& faces) {
  LongVec middle(0);
  long double corners = 0;
  for (const Face& face : faces)
    for (const LongVec& p : face) middle += p, ++corners;
  if (corners == 0) return 0;
  middle /= corners;
  long double volume = 0;
  for (const Face& face : faces)
    for (std::size_t i = 2; i < face.size(); ++i)
      volume += std::abs(glm::dot(face[0] - middle, glm::cross(face[i - 1] - middle, face[i] - middle)));
  return volume / 6;
}

/// The fraction of a voxel of the box that is inside.
inline double voxel_fraction(std::span<const voxel::Triangle> triangles, const Box<double>& box,
                             glm::uvec3 size, glm::uvec3 voxel) {
  const LongVec low(box.low), edge = (LongVec(box.high) - low) / LongVec(size);
  const LongVec apex(LongVec(size) * 0.437L);
  long double sum = 0;
  for (const voxel::Triangle& t : triangles) {
    const LongVec a = (LongVec(t.a) - low) / edge, b = (LongVec(t.b) - low) / edge,
                  c = (LongVec(t.c) - low) / edge;
    std::vector<Face> solid{{a, b, c}, {apex, a, b}, {apex, b, c}, {apex, c, a}};
    for (int axis = 0; axis < 3; ++axis) {
      solid = half(solid, axis, static_cast<long double>(voxel[axis]), -1);
      solid = half(solid, axis, static_cast<long double>(voxel[axis]) + 1, 1);
    }
    const long double facing = glm::dot(a - apex, glm::cross(b - apex, c - apex));
    sum += facing < 0 ? -convex_volume(solid) : convex_volume(solid);
  }
  return static_cast<double>(sum);
}

}  // namespace brume::reference
