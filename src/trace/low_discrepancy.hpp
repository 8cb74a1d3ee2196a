// Sobol's points in two dimensions, and Owen's scrambling of them.
#pragma once

#include <cstdint>

namespace brume::trace {

constexpr std::uint32_t reversed_bits(std::uint32_t bits) {
  bits = (bits >> 16) | (bits << 16);
  bits = (bits >> 8 & 0x00ff00ffu) | (bits & 0x00ff00ffu) << 8;
  bits = (bits >> 4 & 0x0f0f0f0fu) | (bits & 0x0f0f0f0fu) << 4;
  bits = (bits >> 2 & 0x33333333u) | (bits & 0x33333333u) << 2;
  return (bits >> 1 & 0x55555555u) | (bits & 0x55555555u) << 1;
}

/// What Owen's nested scrambling does to bits that are reversed, from the lowest bit on: Vegdahl 2021,
/// "Building a Better LK Hash", after Laine and Karras 2011.
constexpr std::uint32_t scrambled_upwards(std::uint32_t bits, std::uint32_t seed) {
  bits ^= bits * 0x3d20adeau;
  bits += seed;
  bits *= (seed >> 16) | 1u;
  bits ^= bits * 0x05526c56u;
  bits ^= bits * 0x53a22864u;
  return bits;
}

/// Sobol's second coordinate of point i, as a fraction of 2^32; the first coordinate is i reversed.
constexpr std::uint32_t second_of_sobol(std::uint32_t i) {
  std::uint32_t result = 0;
  for (std::uint32_t column = 1u << 31; i != 0; i >>= 1, column ^= column >> 1)
    if (i & 1) result ^= column;
  return result;
}

/// The scrambled coordinates of point i, as fractions of 2^32.
constexpr std::uint32_t first_scrambled(std::uint32_t i, std::uint32_t seed) {
  return reversed_bits(scrambled_upwards(i, seed));
}
constexpr std::uint32_t second_scrambled(std::uint32_t i, std::uint32_t seed) {
  return reversed_bits(scrambled_upwards(reversed_bits(second_of_sobol(i)), seed));
}

/// The bits of both in turn, each of `high` before its counterpart of `low`: Morton's order.
constexpr std::uint64_t interleaved(std::uint32_t high, std::uint32_t low) {
  const auto spread = [](std::uint64_t bits) {
    bits = (bits | bits << 16) & 0x0000ffff0000ffffu;
    bits = (bits | bits << 8) & 0x00ff00ff00ff00ffu;
    bits = (bits | bits << 4) & 0x0f0f0f0f0f0f0f0fu;
    bits = (bits | bits << 2) & 0x3333333333333333u;
    return (bits | bits << 1) & 0x5555555555555555u;
  };
  return spread(high) << 1 | spread(low);
}

}  // namespace brume::trace
