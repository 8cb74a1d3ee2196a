// Fractions as whole numbers, so that they are equal on every machine: 65536 stands for 1.
#pragma once

#include <cstdint>

namespace brume::sim {

inline constexpr std::uint64_t kWhole = 65536;

/// 3x^2 - 2x^3 for x in [0, kWhole].
constexpr std::uint64_t smoothstep(std::uint64_t x) {
  return (x * x * (3 * kWhole - 2 * x)) >> 32;
}

}  // namespace brume::sim
