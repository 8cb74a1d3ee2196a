// The samples of a pixel are a low-discrepancy sequence, and those of neighbours are apart.
#include <complex>
#include <numbers>

#include "surfaces/sampler.hpp"
#include "tests/path_tracer/statistics.hpp"

namespace brume::surfaces {
namespace {

using reference::expect_distribution;

TEST(SamplerTest, EachBlockOfAPixelIsStratified) {
  for (const glm::uvec2 pixel : {glm::uvec2(0), glm::uvec2(5, 3), glm::uvec2(1919, 1079)})
    for (std::uint32_t dimension = 0; dimension < 7; ++dimension)
      for (std::uint32_t bits = 0; bits <= 8; ++bits) {
        // Samples 2^bits to 2^(bits + 1) - 1: one in each box of the area 2^-bits, whatever its shape.
        const std::uint32_t count = 1u << bits;
        std::vector<glm::vec2> points;
        for (std::uint32_t i = count; i < 2 * count; ++i) {
          Sampler sampler(pixel, i);
          sampler.set_dimension(dimension);
          points.push_back(sampler.next_2d());
        }
        for (std::uint32_t across = 0; across <= bits; ++across) {
          std::vector<int> boxes(count);
          for (const glm::vec2 p : points) {
            const auto x = static_cast<std::uint32_t>(p.x * static_cast<float>(1u << across));
            const auto y = static_cast<std::uint32_t>(p.y * static_cast<float>(1u << (bits - across)));
            ++boxes[x + (y << across)];
          }
          EXPECT_EQ(*std::ranges::max_element(boxes), 1) << dimension << ' ' << bits << ' ' << across;
        }
      }
}

/// Mean power of white noise is 1.
double low_frequency_power(std::uint32_t samples) {
  // The error of the integral of a smooth function over the unit square, in each of 64 x 64 pixels.
  constexpr int kEdge = 64;
  std::vector<double> error(kEdge * kEdge);
  double power = 0;
  for (int i = 0; i < kEdge * kEdge; ++i) {
    double sum = 0;
    for (std::uint32_t s = 0; s < samples; ++s) {
      Sampler sampler({static_cast<unsigned>(i % kEdge), static_cast<unsigned>(i / kEdge)}, s);
      const glm::dvec2 p(sampler.next_2d());
      sum += p.x * p.x + p.x * p.y;
    }
    error[static_cast<std::size_t>(i)] = sum / samples - 1.0 / 3 - 0.25;
    power += error[static_cast<std::size_t>(i)] * error[static_cast<std::size_t>(i)];
  }
  // Its spectrum at wavelengths of an eighth of the image and more, without the mean.
  double low = 0;
  int count = 0;
  for (int v = -8; v <= 8; ++v)
    for (int u = -8; u <= 8; ++u) {
      if ((u == 0 && v == 0) || u * u + v * v > 64) continue;
      std::complex<double> sum = 0;
      for (int i = 0; i < kEdge * kEdge; ++i)
        sum += error[static_cast<std::size_t>(i)] *
               std::polar(1.0, -2 * std::numbers::pi * (u * (i % kEdge) + v * (i / kEdge)) / kEdge);
      low += std::norm(sum) / power;
      ++count;
    }
  return low / count;
}

TEST(SamplerTest, ErrorsOfNeighboursAreBlueNoise) {
  for (const std::uint32_t samples : {1u, 2u, 4u, 8u})
    EXPECT_LT(low_frequency_power(samples), 0.25) << samples;
}

TEST(SamplerTest, ErrorsFallFasterThanThoseOfRandomNumbers) {
  const auto rms = [](std::uint32_t samples) {
    double sum = 0;
    for (std::uint32_t pixel = 0; pixel < 256; ++pixel) {
      double mean = 0;
      for (std::uint32_t s = 0; s < samples; ++s) {
        Sampler sampler({pixel % 16, pixel / 16}, s);
        const glm::dvec2 p(sampler.next_2d());
        mean += p.x * p.x * p.y / samples;
      }
      sum += (mean - 1.0 / 6) * (mean - 1.0 / 6);
    }
    return std::sqrt(sum / 256);
  };
  // Random numbers: 0.198 / sqrt(n).
  EXPECT_LT(rms(64), 0.5 * 0.198 / 8);
  EXPECT_LT(rms(1024), 0.2 * 0.198 / 32);
}

// What a path does with one dimension tells nothing about another: neither in a pixel, nor over many of them.
TEST(SamplerTest, DimensionsAreIndependent) {
  constexpr std::uint32_t kEdge = 32;
  for (const glm::uvec2 dimensions :
       {glm::uvec2(0, 1), glm::uvec2(1, 2), glm::uvec2(4, 10), glm::uvec2(5, 29)})
    for (const std::uint32_t samples : {16u, 64u, 256u}) {
      std::vector<double> counts(256);
      double covariance = 0;
      for (std::uint32_t i = 0; i < kEdge * kEdge * samples; ++i) {
        Sampler sampler({i % kEdge, i / kEdge % kEdge}, samples + i / (kEdge * kEdge));
        sampler.set_dimension(dimensions.x);
        const float a = sampler.next_2d().x;
        sampler.set_dimension(dimensions.y);
        const float b = sampler.next_1d();
        ++counts[static_cast<std::size_t>(16 * a) + 16 * static_cast<std::size_t>(16 * b)];
        covariance += (double{a} - 0.5) * (double{b} - 0.5);
      }
      const double count = kEdge * kEdge * samples;
      expect_distribution(counts, std::vector<double>(256, count / 256));
      EXPECT_NEAR(covariance / count, 0, 4 / (12 * std::sqrt(count))) << dimensions.x << ' ' << dimensions.y;
    }
}

TEST(SamplerTest, RandomNumbersAreUniformAndIndependentOfThePixelsAround) {
  std::vector<double> counts(256);
  for (std::uint32_t i = 0; i < 65536; ++i) {
    Sampler sampler({i & 255u, i >> 8u}, 1);
    const auto x = static_cast<std::size_t>(16 * sampler.random()),
               y = static_cast<std::size_t>(16 * sampler.random());
    ++counts[x + 16 * y];
  }
  expect_distribution(counts, std::vector<double>(256, 256));
}

TEST(SamplerTest, NumbersAreBelowOne) {
  for (std::uint32_t i = 0; i < 10000; ++i) {
    Sampler sampler({i, 3 * i}, i);
    for (int k = 0; k < 4; ++k) {
      EXPECT_LT(sampler.next_1d(), 1);
      EXPECT_LT(sampler.random(), 1);
    }
  }
}

}  // namespace
}  // namespace brume::surfaces
