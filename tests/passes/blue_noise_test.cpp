#include "passes/blue_noise.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace brume::passes {
namespace {

TEST(BlueNoise, EveryValueEquallyOften) {
  std::array<int, 256> count{};
  for (const std::uint8_t value : blue_noise_channel(3)) ++count[value];
  for (const int n : count) EXPECT_EQ(n, static_cast<int>(kBlueNoiseSize * kBlueNoiseSize / 256));
}

TEST(BlueNoise, ChannelsDiffer) {
  EXPECT_NE(blue_noise_channel(0), blue_noise_channel(1));
}

/// Mean power of the tile at the frequencies of radius `low` to `high` (cycles a tile), white noise: 1.
double power(const std::vector<std::uint8_t>& tile, double low, double high) {
  const int n = static_cast<int>(kBlueNoiseSize);
  double sum = 0;
  int count = 0;
  for (int v = -n / 2; v < n / 2; ++v) {
    for (int u = 0; u < n / 2; ++u) {
      const double radius = std::hypot(u, v);
      if (radius < low || radius >= high) continue;
      double re = 0, im = 0;
      for (int y = 0; y < n; ++y) {
        for (int x = 0; x < n; ++x) {
          const double angle = 2 * std::numbers::pi * (u * x + v * y) / n;
          const double value = tile[static_cast<std::size_t>(y * n + x)] - 127.5;
          re += value * std::cos(angle);
          im += value * std::sin(angle);
        }
      }
      sum += re * re + im * im;
      ++count;
    }
  }
  const double variance = (256.0 * 256.0 - 1) / 12;
  return sum / count / (variance * n * n);
}

TEST(BlueNoise, HasNoLowFrequencies) {
  const auto tile = blue_noise_channel(0);
  EXPECT_LT(power(tile, 0.5, 6), 0.05);  // a tenth of the band, almost nothing in it
  EXPECT_GT(power(tile, 24, 30), 0.9);
}

}  // namespace
}  // namespace brume::passes
