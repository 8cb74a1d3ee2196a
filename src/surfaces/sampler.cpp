#include "surfaces/sampler.hpp"

#include <array>
#include <bit>

#include "trace/low_discrepancy.hpp"

namespace brume::surfaces {
namespace {

/// Digits of the Morton code, of base 4, that are shuffled; images that are larger repeat.
constexpr std::uint32_t kDigits = 11;

/// All orders of four digits, two bits each.
constexpr std::array<std::uint8_t, 24> orders_of_four() {
  std::array<std::uint8_t, 24> orders{};
  std::size_t count = 0;
  for (unsigned a = 0; a < 4; ++a)
    for (unsigned b = 0; b < 4; ++b)
      for (unsigned c = 0; c < 4; ++c) {
        const unsigned d = 6 - a - b - c;
        if (a == b || a == c || b == c || d > 3 || d == a || d == b || d == c) continue;
        orders[count++] = static_cast<std::uint8_t>(a | b << 2 | c << 4 | d << 6);
      }
  return orders;
}
constexpr std::array<std::uint8_t, 24> kOrders = orders_of_four();

}  // namespace

Sampler::Sampler(glm::uvec2 pixel, std::uint32_t sample)
    : morton_(static_cast<std::uint32_t>(trace::interleaved(pixel.y, pixel.x))),
      block_(static_cast<std::uint32_t>(std::bit_width(sample))),
      in_block_(sample == 0 ? 0 : sample - (1u << (block_ - 1))),
      block_bits_(block_ == 0 ? 0 : block_ - 1) {
  const glm::uvec3 seed = shared::pcg3d({pixel.x, pixel.y, sample});
  state_ = std::uint64_t{seed.x} << 32 | seed.y;
  increment_ = std::uint64_t{seed.z} << 1 | 1u;
  random();
}

std::uint32_t Sampler::point_in_sequence(std::uint32_t dimension) const {
  const std::uint32_t seed = mix_bits(dimension * 0x9e3779b9u + block_);
  std::uint32_t shuffled = 0;
  for (std::uint32_t digit = kDigits; digit-- > 0;) {
    const std::uint32_t higher = digit == 15 ? 0 : morton_ >> (2 * digit + 2);
    const std::uint32_t order = kOrders[(std::uint64_t{mix_bits(higher ^ seed ^ digit << 27)} * 24) >> 32];
    shuffled = shuffled << 2 | (order >> (2 * (morton_ >> (2 * digit) & 3u)) & 3u);
  }
  if (block_bits_ == 0) return shuffled;
  // The points of a block come in another order in each dimension and pixel: otherwise the k-th of all
  // dimensions would lie in strata that belong together, and paths would meet a part of what they can only.
  // Nested, so that parts of a block are stratified, too.
  const std::uint32_t unused = 32 - block_bits_;
  const std::uint32_t mine = trace::first_scrambled(trace::reversed_bits(in_block_) >> unused,
                                                    mix_bits(morton_ ^ mix_bits(~seed))) >>
                             unused;
  return shuffled << block_bits_ | mine;
}

void Sampler::throw_if_stopped() const {
  if ((*stopped_)()) throw Stopped();
}

float Sampler::next_1d() {
  const std::uint32_t dimension = dimension_++;
  const std::uint32_t seed = mix_bits(dimension * 0x85ebca6bu ^ block_ * 0xc2b2ae35u);
  return unit_float(trace::first_scrambled(point_in_sequence(dimension), seed));
}

glm::vec2 Sampler::next_2d() {
  const std::uint32_t dimension = dimension_++;
  const std::uint32_t seed = mix_bits(dimension * 0x85ebca6bu ^ block_ * 0xc2b2ae35u);
  const std::uint32_t point = point_in_sequence(dimension);
  return {unit_float(trace::first_scrambled(point, seed)),
          unit_float(trace::second_scrambled(point, mix_bits(seed)))};
}

}  // namespace brume::surfaces
