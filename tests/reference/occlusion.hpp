// Ambient occlusion by brute force in double precision, and form factors.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>
#include <random>
#include <span>
#include <vector>

#include "voxel/triangle.hpp"

namespace brume::reference {

/// Möller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection", for many rays from one point:
/// their products with the direction, reordered.
struct TriangleFromPoint {
  glm::dvec3 determinant, u, v;
  double t;

  TriangleFromPoint(const voxel::Triangle& triangle, glm::dvec3 p) {
    const glm::dvec3 a(triangle.a), ab = glm::dvec3(triangle.b) - a, ac = glm::dvec3(triangle.c) - a;
    determinant = glm::cross(ac, ab);
    u = glm::cross(ac, p - a);
    v = glm::cross(p - a, ab);
    t = glm::dot(ac, v);
  }
  bool hides(glm::dvec3 direction) const {
    const double all = glm::dot(determinant, direction), sign = all < 0 ? -1 : 1;
    const double part_u = sign * glm::dot(u, direction), part_v = sign * glm::dot(v, direction);
    return all != 0 && sign * t > 0 && part_u >= 0 && part_v >= 0 && part_u + part_v <= sign * all;
  }
};

/// The fraction of cosine-weighted random rays around +y (`side` 1) or -y (-1) that the triangles hide.
inline double hidden_fraction(std::span<const voxel::Triangle> triangles, glm::dvec3 p, double side, int rays,
                              std::mt19937_64& random) {
  std::vector<TriangleFromPoint> all;
  for (const voxel::Triangle& triangle : triangles) all.emplace_back(triangle, p);
  std::uniform_real_distribution<double> uniform;
  int hidden = 0;
  for (int i = 0; i < rays; ++i) {
    const double sine_squared = uniform(random), around = glm::two_pi<double>() * uniform(random);
    const double sine = std::sqrt(sine_squared);
    const glm::dvec3 direction(sine * std::cos(around), side * std::sqrt(1 - sine_squared),
                               sine * std::sin(around));
    hidden += std::any_of(all.begin(), all.end(),
                          [&](const TriangleFromPoint& one) { return one.hides(direction); });
  }
  return static_cast<double>(hidden) / rays;
}

/// From a small patch at the origin to a rectangle parallel to it at a height: four rectangles with a corner
/// straight above the patch (Howell, "A Catalog of Radiation Heat Transfer Configuration Factors", B-4).
inline double form_factor_of_rectangle(glm::dvec2 low, glm::dvec2 high, double height) {
  const auto corner = [&](double x, double y) {
    const double a = x / height, b = y / height, c = std::sqrt(1 + a * a), d = std::sqrt(1 + b * b);
    return (a / c * std::atan(b / c) + b / d * std::atan(a / d)) / glm::two_pi<double>();
  };
  return corner(high.x, high.y) - corner(low.x, high.y) - corner(high.x, low.y) + corner(low.x, low.y);
}

/// The cells among edge x edge of the square, mapped to the disk below a hemisphere (Shirley and Chiu 1997),
/// in which some directions are hidden and others not, as far as 5 x 5 directions of each show.
template <typename IsHidden>
std::size_t count_mixed_cells(std::size_t edge, IsHidden is_hidden) {
  // Directions on the corners of a grid four times as fine.
  const std::size_t corners = 4 * edge + 1;
  std::vector<char> hidden(corners * corners);
  for (std::size_t j = 0; j < corners; ++j)
    for (std::size_t i = 0; i < corners; ++i) {
      const double a = 2.0 * static_cast<double>(i) / static_cast<double>(corners - 1) - 1;
      const double b = 2.0 * static_cast<double>(j) / static_cast<double>(corners - 1) - 1;
      const bool wide = std::abs(a) > std::abs(b);
      const double radius = wide ? a : b;
      const double turn = radius == 0 ? 0 : glm::quarter_pi<double>() * (wide ? b / a : a / b);
      const double along = radius * std::cos(turn), aside = radius * std::sin(turn);
      hidden[i + corners * j] = is_hidden(glm::dvec3(
          wide ? along : aside, std::sqrt(std::max(0.0, 1 - radius * radius)), wide ? aside : along));
    }
  // Cells of both kinds.
  std::size_t mixed = 0;
  for (std::size_t y = 0; y < edge; ++y)
    for (std::size_t x = 0; x < edge; ++x) {
      int count = 0;
      for (std::size_t k = 0; k < 25; ++k) count += hidden[4 * x + k % 5 + corners * (4 * y + k / 5)];
      mixed += count > 0 && count < 25;
    }
  return mixed;
}

}  // namespace brume::reference
