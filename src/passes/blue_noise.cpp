#include "passes/blue_noise.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "core/tasks.hpp"

namespace brume::passes {
namespace {

constexpr std::uint32_t kCount = kBlueNoiseSize * kBlueNoiseSize;

// As a float, exp(-d^2 / 4.5) is 0 for all greater distances.
constexpr std::uint32_t kReach = 22;

/// The points chosen so far and how crowded each place of the torus is.
class Pattern {
 public:
  Pattern() : falloff_(2 * kCount), energy_(kCount, 0), free_(kCount, -1) {
    constexpr float kSigma = 1.5f;  // Ulichney's value
    for (std::uint32_t y = 0; y < kBlueNoiseSize; ++y) {
      for (std::uint32_t x = 0; x < 2 * kBlueNoiseSize; ++x) {
        const auto dx = static_cast<float>(distance(x % kBlueNoiseSize)),
                   dy = static_cast<float>(distance(y));
        falloff_[2 * kBlueNoiseSize * y + x] = std::exp(-(dx * dx + dy * dy) / (2 * kSigma * kSigma));
      }
    }
  }
  void set(std::uint32_t point, bool chosen) {
    free_[point] = chosen ? 0 : -1;
    // Not a factor of 1 or -1: a processor multiplies subnormal numbers much slower than it adds them.
    if (chosen)
      update(point, [](float energy, float falloff) { return energy + falloff; });
    else
      update(point, [](float energy, float falloff) { return energy - falloff; });
  }
  /// The chosen point with the most energy.
  std::uint32_t tightest_cluster() const { return least(-1, 0); }
  /// The free point with the least energy.
  std::uint32_t largest_void() const { return least(0, -1); }
  bool chosen(std::uint32_t point) const { return free_[point] == 0; }

 private:
  static constexpr std::int32_t kNone = std::numeric_limits<std::int32_t>::max();

  static std::uint32_t distance(std::uint32_t d) { return std::min(d, kBlueNoiseSize - d); }
  /// The bits of a float as a number with the order of the floats; 0 is never negative here.
  static std::int32_t ordered(float value) {
    const auto bits = std::bit_cast<std::int32_t>(value);
    return bits ^ ((bits >> 31) & 0x7fffffff);
  }
  template <typename Change>
  void update(std::uint32_t point, Change change) {
    const std::uint32_t px = point % kBlueNoiseSize, py = point / kBlueNoiseSize;
    for (std::uint32_t y = 0; y < kBlueNoiseSize; ++y) {
      const std::uint32_t row = (y + kBlueNoiseSize - py) % kBlueNoiseSize;
      if (distance(row) > kReach) continue;
      const float* falloff = &falloff_[2 * kBlueNoiseSize * row + kBlueNoiseSize - px];
      float* energy = &energy_[y * kBlueNoiseSize];
      for (std::uint32_t x = 0; x < kBlueNoiseSize; ++x) energy[x] = change(energy[x], falloff[x]);
    }
  }
  /// A place's energy with the bits of `flip` inverted, in the order of integers; kNone unless free_ ==
  /// `free`.
  std::int32_t key(std::uint32_t i, std::int32_t flip, std::int32_t free) const {
    const std::int32_t other =
        free_[i] ^ free;  // 0 or -1: without a branch, the compiler vectorizes the search
    return ((ordered(energy_[i]) ^ flip) & ~other) | (kNone & other);
  }
  /// The first place with the least key.
  std::uint32_t least(std::int32_t flip, std::int32_t free) const {
    std::int32_t best = kNone;
    std::uint32_t best_row = 0;
    for (std::uint32_t y = 0; y < kBlueNoiseSize; ++y) {
      std::int32_t of_row = kNone;
      for (std::uint32_t x = 0; x < kBlueNoiseSize; ++x)
        of_row = std::min(of_row, key(y * kBlueNoiseSize + x, flip, free));
      if (of_row < best) {
        best = of_row;
        best_row = y;
      }
    }
    std::uint32_t i = best_row * kBlueNoiseSize;
    while (key(i, flip, free) != best) ++i;
    return i;
  }
  std::vector<float> falloff_;  ///< Rows twice, so that those from any start are in one piece.
  std::vector<float> energy_;
  std::vector<std::int32_t> free_;  ///< -1: free, 0: chosen.
};

/// A random tenth of the points, moved from clusters to voids until nothing moves.
Pattern initial_pattern(std::uint32_t seed) {
  Pattern pattern;
  std::uint64_t state = 0x9e3779b97f4a7c15ull * (seed + 1);
  for (std::uint32_t placed = 0; placed < kCount / 10;) {
    state = state * 6364136223846793005ull + 1442695040888963407ull;
    const auto point = static_cast<std::uint32_t>((state >> 33) % kCount);
    if (pattern.chosen(point)) continue;
    pattern.set(point, true);
    ++placed;
  }
  for (std::uint32_t moves = 0; moves < kCount; ++moves) {
    const std::uint32_t from = pattern.tightest_cluster();
    pattern.set(from, false);
    const std::uint32_t to = pattern.largest_void();
    pattern.set(to, true);
    if (from == to) break;
  }
  return pattern;
}

}  // namespace

std::vector<std::uint8_t> blue_noise_channel(std::uint32_t seed) {
  const Pattern initial = initial_pattern(seed);
  std::vector<std::uint32_t> rank(kCount);
  // Ranks below the initial pattern's size: take its points away, tightest first.
  Pattern pattern = initial;
  for (std::uint32_t i = kCount / 10; i-- > 0;) {
    const std::uint32_t point = pattern.tightest_cluster();
    pattern.set(point, false);
    rank[point] = i;
  }
  // Ranks above: fill the voids, largest first.
  pattern = initial;
  for (std::uint32_t i = kCount / 10; i < kCount; ++i) {
    const std::uint32_t point = pattern.largest_void();
    pattern.set(point, true);
    rank[point] = i;
  }
  std::vector<std::uint8_t> values(kCount);
  for (std::uint32_t i = 0; i < kCount; ++i) values[i] = static_cast<std::uint8_t>(rank[i] * 256 / kCount);
  return values;
}

gpu::Image make_blue_noise(gpu::Context& context, gpu::Recorder& recorder) {
  std::vector<std::byte> rgba(kCount * 4);
  parallel_for(4, 1, [&](std::size_t begin, std::size_t) {
    const auto channel = blue_noise_channel(static_cast<std::uint32_t>(begin));
    for (std::uint32_t i = 0; i < kCount; ++i) rgba[4 * i + begin] = static_cast<std::byte>(channel[i]);
  });
  gpu::Image image(context, gpu::sampled_image(glm::uvec2(kBlueNoiseSize), VK_FORMAT_R8G8B8A8_UNORM));
  const gpu::Recorder::Region all{rgba, glm::ivec3(0), image.info().size};
  recorder.upload(image, {&all, 1});
  return image;
}

}  // namespace brume::passes
