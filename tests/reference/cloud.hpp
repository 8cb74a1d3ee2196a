// Clouds by formula in double precision, and how far floats may be from them.
#pragma once

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

#include "shared/cloud.h"
#include "tests/reference/noise.hpp"

namespace brume::reference {

/// Gradient noise: every lattice point within a cell adds its ramp, faded out by distance.
inline double lattice_noise(glm::dvec3 p, std::uint32_t seed) {
  // Directions to the edges of a cube, twice four of them (Perlin 2002).
  static constexpr int kEdges[16][3] = {
      {1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
      {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1}, {1, 1, 0}, {0, -1, 1}, {-1, 1, 0}, {0, -1, -1}};
  const glm::ivec3 cell(glm::floor(p));
  double sum = 0;
  for (int z = 0; z <= 1; ++z)
    for (int y = 0; y <= 1; ++y)
      for (int x = 0; x <= 1; ++x) {
        const glm::ivec3 corner = cell + glm::ivec3(x, y, z);
        const glm::dvec3 apart = p - glm::dvec3(corner);
        double fade = 1;
        for (int axis = 0; axis < 3; ++axis) {
          const double f = std::abs(apart[axis]);
          fade *= 1 - f * f * f * (f * (f * 6 - 15) + 10);
        }
        const std::uint32_t hash =
            pcg3d(glm::uvec3(corner) + seed * glm::uvec3(0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du)).x >> 28;
        const int* edge = kEdges[hash];
        sum += fade * (edge[0] * apart.x + edge[1] * apart.y + edge[2] * apart.z);
      }
  return sum;
}

inline double cloud_depth(const shared::CloudShape& shape, glm::dvec3 p) {
  const double r = double{shape.radius};
  if (shape.kind == shared::kCloudSlab)
    return std::min({r - std::abs(p.x), r / 4 - std::abs(p.y), r - std::abs(p.z)});
  if (shape.kind == shared::kCloudTorus) return r / 4 - std::hypot(std::hypot(p.x, p.z) - 0.75 * r, p.y);
  double noise = 0;
  if (shape.kind == shared::kCloudPyroclastic)
    for (std::uint32_t i = 0; i < shape.octaves; ++i)
      noise +=
          std::pow(double{shape.gain}, i) *
          lattice_noise(p * double{shape.frequency} * std::pow(double{shape.lacunarity}, i), shape.seed + i);
  return r + double{shape.amplitude} * std::abs(noise) - glm::length(p);
}

/// How far the depth of a point may be off when it is computed in floats [m].
///
/// Noise changes by at most 25 per cell that all axes move by: the ramps by 2, and the weights, whose slope
/// is at most 1.875, by 2 * 1.875 per axis times a ramp of at most 2. The position in octave i is the product
/// of i + 2 rounded factors. 64 roundings of values up to 2 cover an octave's own arithmetic, 16 the rest.
inline double cloud_depth_error(const shared::CloudShape& shape, glm::dvec3 p) {
  constexpr double kRound = 1.0 / (1 << 24);
  const double farthest = std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)});
  double noise = 0;
  if (shape.kind == shared::kCloudPyroclastic)
    for (std::uint32_t i = 0; i < shape.octaves; ++i) {
      const double cells = farthest * double{shape.frequency} * std::pow(double{shape.lacunarity}, i);
      noise += std::pow(double{shape.gain}, i) * (25 * cells * (i + 2) + 64 * 2) * kRound;
    }
  return double{shape.amplitude} * noise + 16 * kRound * (double{shape.radius} + 2 * farthest);
}

}  // namespace brume::reference
