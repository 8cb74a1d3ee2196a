#include "bake/winding_number.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace brume::bake {
namespace {

using glm::dvec3;

constexpr std::size_t kLeafTriangles = 2;
// The expansion is used beyond this many radii of a group.
constexpr double kFarRadii = 2;

bool all_finite(const glm::vec3& p) {
  return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z);
}

}  // namespace

double solid_angle(const dvec3& a, const dvec3& b, const dvec3& c) {
  const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
  const double volume = glm::dot(a, glm::cross(b, c));
  const double along = la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb;
  return 2 * std::atan2(volume, along);
}

WindingTree::WindingTree(std::span<const voxel::Triangle> triangles) {
  triangles_.reserve(triangles.size());
  for (const voxel::Triangle& t : triangles)
    if (all_finite(t.a) && all_finite(t.b) && all_finite(t.c))
      triangles_.push_back({dvec3(t.a), dvec3(t.b), dvec3(t.c)});
  if (!triangles_.empty()) add_node(0, triangles_.size());
}

void WindingTree::add_node(std::size_t first, std::size_t count) {
  const std::size_t at = nodes_.size();
  nodes_.push_back(expanded(std::span(triangles_).subspan(first, count)));
  if (count <= kLeafTriangles) {
    nodes_[at].first = static_cast<std::uint32_t>(first);
    nodes_[at].count = static_cast<std::uint32_t>(count);
  } else {
    // Halve it across the longest axis of its box.
    const auto centroid = [](const Corners& t, int axis) { return t.a[axis] + t.b[axis] + t.c[axis]; };
    dvec3 low(INFINITY), high(-INFINITY);
    for (std::size_t i = first; i < first + count; ++i) {
      const dvec3 sum = triangles_[i].a + triangles_[i].b + triangles_[i].c;
      low = glm::min(low, sum);
      high = glm::max(high, sum);
    }
    const dvec3 extent = high - low;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    const auto begin = triangles_.begin() + static_cast<std::ptrdiff_t>(first);
    const std::size_t half = count / 2;
    std::nth_element(
        begin, begin + static_cast<std::ptrdiff_t>(half), begin + static_cast<std::ptrdiff_t>(count),
        [&](const Corners& s, const Corners& t) { return centroid(s, axis) < centroid(t, axis); });
    add_node(first, half);
    add_node(first + half, count - half);
  }
  nodes_[at].next = static_cast<std::uint32_t>(nodes_.size());
}

// The expansion about the area's centroid, where its second term is small. The solid angle of a small area
// with normal n at r + d is n . f(r + d) with f(r) = r / |r|^3. Its Taylor series in d has the moments of the
// triangles as coefficients: sum(area n), sum(n d^T) and sum(n d d^T). Derivatives of f are symmetric in all
// indices, because f = -grad(1 / |r|):
//   f_i,j  = delta_ij / |r|^3 - 3 r_i r_j / |r|^5
//   f_i,jk = 15 r_i r_j r_k / |r|^7 - 3 (delta_ij r_k + delta_jk r_i + delta_ki r_j) / |r|^5
WindingTree::Node WindingTree::expanded(std::span<const Corners> triangles) {
  // The centre.
  Node node;
  double area = 0;
  dvec3 weighted(0), middle(0);
  for (const Corners& t : triangles) {
    const dvec3 centroid = (t.a + t.b + t.c) / 3.0;
    const double size = 0.5 * glm::length(glm::cross(t.b - t.a, t.c - t.a));
    area += size;
    weighted += size * centroid;
    middle += centroid;
  }
  node.centre = area > 0 ? weighted / area : middle / static_cast<double>(triangles.size());

  // The moments, integrated over each triangle.
  double radius_squared = 0;
  glm::dmat3 second(0), third(0);  // [j][i]: of n_i d_j; of (n_j d_i + 2 n_i d_j) d_i.
  for (const Corners& t : triangles) {
    const dvec3 n = 0.5 * glm::cross(t.b - t.a, t.c - t.a);
    const dvec3 a = t.a - node.centre, b = t.b - node.centre, c = t.c - node.centre, sum = a + b + c;
    const glm::dmat3 d2 = (glm::outerProduct(a, a) + glm::outerProduct(b, b) + glm::outerProduct(c, c) +
                           glm::outerProduct(sum, sum)) /
                          12.0;
    node.dipole += n;
    second += glm::outerProduct(n, sum / 3.0);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) third[j][i] += n[j] * d2[i][i] + 2 * n[i] * d2[i][j];
    node.xyz += 15 * (n.x * d2[1][2] + n.y * d2[2][0] + n.z * d2[0][1]);
    radius_squared = std::max({radius_squared, glm::dot(a, a), glm::dot(b, b), glm::dot(c, c)});
  }
  node.far_squared = kFarRadii * kFarRadii * radius_squared;

  // As polynomials of r.
  const double trace = second[0][0] + second[1][1] + second[2][2];
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    node.squares[i] = trace - 3 * second[i][i];
    node.products[i] = -3 * (second[j][k] + second[k][j]);
    const double along = third[i][0] + third[i][1] + third[i][2];
    for (int axis = 0; axis < 3; ++axis)
      node.cubes[i][axis] = 7.5 * third[i][axis] * (axis == i ? 1.0 / 3 : 1.0) - 1.5 * along;
  }
  return node;
}

double WindingTree::winding_number(const dvec3& point) const {
  double sum = 0;
  for (std::size_t i = 0; i < nodes_.size();) {
    const Node& node = nodes_[i];
    const dvec3 r = node.centre - point;
    const double squared = glm::dot(r, r);
    if (squared > node.far_squared) {
      // Far away, the expansion stands for the whole subtree.
      const dvec3 r2 = r * r;
      const double inverse = 1 / squared;
      const double quadrupole =
          glm::dot(node.squares, r2) + glm::dot(node.products, dvec3(r.y * r.z, r.z * r.x, r.x * r.y));
      const double octupole = glm::dot(r2, node.cubes * r) + node.xyz * r.x * r.y * r.z;
      sum += inverse / std::sqrt(squared) *
             (glm::dot(node.dipole, r) + inverse * (quadrupole + inverse * octupole));
      i = node.next;
    } else if (node.count > 0) {
      // Near triangles count one by one.
      for (std::size_t k = node.first; k < node.first + node.count; ++k) {
        const Corners& t = triangles_[k];
        sum += solid_angle(t.a - point, t.b - point, t.c - point);
      }
      i = node.next;
    } else {
      // Near groups are opened: their children follow.
      ++i;
    }
  }
  return sum / (4 * std::numbers::pi);
}

}  // namespace brume::bake
