// Random numbers of packing: a function of what they are for, so that no thread has a state of its own.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace brume::spheres {

/// SplitMix64 (Steele, Lea and Flood 2014, "Fast Splittable Pseudorandom Number Generators").
class PackRandom {
 public:
  PackRandom(std::uint64_t seed, std::uint64_t stream, std::uint64_t number)
      : state_(mix(mix(mix(seed) + stream) + number)) {}
  std::uint64_t bits() { return mix(state_ += 0x9e3779b97f4a7c15u); }
  /// In [0, 1).
  double unit() { return static_cast<double>(bits() >> 11) * 0x1p-53; }
  glm::dvec3 unit3() {
    const double x = unit(), y = unit();
    return {x, y, unit()};
  }
  /// In [0, count).
  std::uint32_t below(std::uint32_t count) {
    return static_cast<std::uint32_t>((bits() >> 32) * count >> 32);
  }
  static constexpr std::uint64_t mix(std::uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }

 private:
  std::uint64_t state_;
};

}  // namespace brume::spheres
