// The kinds of noise in double precision, with their own loops: cells are searched over the whole torus,
// derivatives are differences.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/glm.hpp>

namespace brume::reference {

inline glm::uvec3 pcg3d(glm::uvec3 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  return v;
}

inline glm::dvec3 lattice_hash(glm::ivec3 at, int cells, std::uint32_t seed) {
  const glm::uvec3 wrapped(((at % cells) + cells) % cells);
  return glm::dvec3(pcg3d(wrapped + seed * glm::uvec3(0x9e3779b1u, 0x85ebca77u, 0xc2b2ae3du)) >> 8u) /
         16777216.0;
}

inline double worley(glm::dvec3 p_tile, int cells, std::uint32_t seed) {
  const glm::dvec3 p = p_tile - glm::floor(p_tile);
  double nearest = 1;
  for (int z = 0; z < cells; ++z)
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x) {
        const glm::dvec3 feature = glm::dvec3(x, y, z) + lattice_hash({x, y, z}, cells, seed);
        glm::dvec3 apart = glm::abs(feature - p * static_cast<double>(cells));
        apart = glm::min(apart, static_cast<double>(cells) - apart);  // over the edge of the torus
        nearest = std::min(nearest, glm::length(apart));
      }
  return 1 - nearest;
}

inline double perlin(glm::dvec3 p_tile, int cells, std::uint32_t seed) {
  const glm::dvec3 p = p_tile * static_cast<double>(cells), low = glm::floor(p);
  double sum = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::dvec3 corner = low + glm::dvec3(i & 1, i >> 1 & 1, i >> 2), apart = p - corner;
    double share = 1;
    for (int axis = 0; axis < 3; ++axis) {
      const double f = std::abs(apart[axis]);
      share *= 1 - f * f * f * (f * (f * 6 - 15) + 10);
    }
    sum += share * glm::dot(glm::normalize(2.0 * lattice_hash(glm::ivec3(corner), cells, seed) - 1.0), apart);
  }
  return sum;
}

/// Derivative by the point in cells.
inline glm::dvec3 perlin_gradient(glm::dvec3 p_tile, int cells, std::uint32_t seed) {
  glm::dvec3 gradient;
  const double h = 1e-5;
  for (int axis = 0; axis < 3; ++axis) {
    glm::dvec3 d(0);
    d[axis] = h;
    gradient[axis] = (perlin(p_tile + d, cells, seed) - perlin(p_tile - d, cells, seed)) / (2 * h * cells);
  }
  return gradient;
}

inline glm::dvec3 curl_noise(glm::dvec3 p, int cells, std::uint32_t seed) {
  const glm::dvec3 x = perlin_gradient(p, cells, seed), y = perlin_gradient(p, cells, seed + 1),
                   z = perlin_gradient(p, cells, seed + 2);
  return {z.y - y.z, x.z - z.x, y.x - x.y};
}

/// Sum over octaves of weight x one(cells, seed) by the sum of the weights.
double octaves(int cells, std::uint32_t count, std::uint32_t seed, auto one) {
  double sum = 0, total = 0;
  for (std::uint32_t octave = 0; octave < count; ++octave) {
    const double weight = std::pow(0.5, octave);
    sum += weight * one(cells << octave, seed + octave);
    total += weight;
  }
  return sum / total;
}

inline double worley_octaves(glm::dvec3 p, int cells, std::uint32_t count, std::uint32_t seed) {
  return octaves(cells, count, seed, [&](int c, std::uint32_t s) { return worley(p, c, s); });
}

inline double perlin_octaves(glm::dvec3 p, int cells, std::uint32_t count, std::uint32_t seed) {
  return octaves(cells, count, seed, [&](int c, std::uint32_t s) { return perlin(p, c, s); });
}

inline double perlin_worley(glm::dvec3 p, int cells, std::uint32_t count, std::uint32_t seed) {
  const double base = 0.5 + 0.5 * perlin_octaves(p, cells, count, seed);
  const double far = 1 - worley_octaves(p, cells, count, seed + 16);
  return base + (1 - base) * (1 - far * far);
}

inline double threads(glm::dvec3 p, int cells, std::uint32_t count, std::uint32_t seed) {
  return octaves(cells, count, seed, [&](int c, std::uint32_t s) { return 1 - std::abs(perlin(p, c, s)); });
}

inline double spread(double value, double mean, double deviation) {
  return 1 / (1 + std::exp(-1.702 * (value - mean) / deviation));
}

}  // namespace brume::reference
