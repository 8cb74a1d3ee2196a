// The random numbers of one path.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>

#include "shared/hash.h"

namespace brume::surfaces {

/// A fraction of 2^32 as a float in [0, 1).
inline float unit_float(std::uint32_t bits) {
  return static_cast<float>(bits >> 8) * 0x1p-24f;
}

/// "lowbias32" of Wellons 2018, "Prospecting for Hash Functions".
constexpr std::uint32_t mix_bits(std::uint32_t x) {
  x ^= x >> 16;
  x *= 0x7feb352du;
  x ^= x >> 15;
  x *= 0x846ca68bu;
  return x ^ x >> 16;
}

/// Numbers in [0, 1) for sample `sample` of a pixel; the same for the same arguments. Two kinds:
///
/// - next_1d and next_2d count a dimension each. In each dimension, the samples of a pixel are a scrambled
///   Sobol sequence, in blocks that double: 1, 1, 2, 4, ... Within a block, the pixels take successive
///   points of one sequence along a shuffled Morton curve, so that what neighbours get wrong cancels out
///   (Ahmed and Wonka 2020, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical
///   Ordering of Pixels"). Every block has its own scrambling, so that blocks are independent. Each pixel
///   takes its points of a block in an order of its own in each dimension, so that dimensions are
///   independent.
/// - `random` is an independent sequence, for decisions whose number is unknown.
class Sampler {
 public:
  Sampler(glm::uvec2 pixel, std::uint32_t sample);

  float next_1d();
  glm::vec2 next_2d();
  float random() {
    // PCG-XSH-RR (O'Neill 2014, "PCG: A Family of Simple Fast Space-Efficient Statistically Good
    // Algorithms for Random Number Generation").
    const std::uint64_t old = state_;
    // The lowest bits run through all values: this is every 4096th number.
    if ((old & 4095u) == 0 && stopped_) throw_if_stopped();
    state_ = old * 6364136223846793005u + increment_;
    const auto mixed = static_cast<std::uint32_t>(((old >> 18) ^ old) >> 27);
    const auto turn = static_cast<std::uint32_t>(old >> 59);
    return unit_float((mixed >> turn) | (mixed << ((32u - turn) & 31u)));
  }
  /// Thrown by `random`.
  struct Stopped {};
  /// Makes `random` throw Stopped within 4096 numbers of the time from which on `stopped` returns true, so
  /// that a path that may take hours ends, too. It must outlive this; null: never.
  void stop_by(const std::function<bool()>* stopped) { stopped_ = stopped; }
  /// The dimensions that follow begin here, whatever was drawn before.
  void set_dimension(std::uint32_t dimension) { dimension_ = dimension; }

 private:
  std::uint32_t point_in_sequence(std::uint32_t dimension) const;
  void throw_if_stopped() const;

  std::uint32_t morton_;      // code of the pixel
  std::uint32_t block_;       // number of the block that holds the sample
  std::uint32_t in_block_;    // number of the sample in its block
  std::uint32_t block_bits_;  // logarithm of the block's size
  std::uint32_t dimension_ = 0;
  std::uint64_t state_, increment_;
  const std::function<bool()>* stopped_ = nullptr;
};

}  // namespace brume::surfaces
