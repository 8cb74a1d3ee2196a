// Integer noise: the same bits on every machine.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace brume::sim {

/// Noise at a point of the integer lattice, uniform in [0, 255].
inline std::uint32_t lattice_noise(glm::ivec3 at, std::uint32_t seed) {
  std::uint32_t h = seed ^ static_cast<std::uint32_t>(at.x) * 0x9e3779b1u ^
                    static_cast<std::uint32_t>(at.y) * 0x85ebca77u ^
                    static_cast<std::uint32_t>(at.z) * 0xc2b2ae3du;
  h = (h ^ h >> 15) * 0x2c1b3c6du;
  h = (h ^ h >> 12) * 0x297a2d39u;
  return (h ^ h >> 15) >> 24;
}

/// Value noise, smoothly interpolated between lattice points, [0, 255]; the point in 1/256 cell, each
/// component in [0, 2^31).
inline std::uint32_t value_noise(glm::ivec3 point_256, std::uint32_t seed) {
  const glm::ivec3 cell = point_256 >> 8;
  std::uint32_t weight[3];  // weights of the upper corners, [0, 256]
  for (int axis = 0; axis < 3; ++axis) {
    const auto f = static_cast<std::uint32_t>(point_256[axis] & 255);
    weight[axis] = (f * f * (768 - 2 * f)) >> 16;
  }
  std::uint32_t sum = 0;
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 upper(i & 1, i >> 1 & 1, i >> 2);
    std::uint32_t corner_weight = 1;  // in units of 2^-24
    for (int axis = 0; axis < 3; ++axis) corner_weight *= upper[axis] ? weight[axis] : 256 - weight[axis];
    sum += lattice_noise(cell + upper, seed) * (corner_weight >> 8);
  }
  return sum >> 16;
}

}  // namespace brume::sim
