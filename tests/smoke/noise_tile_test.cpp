#include "smoke/noise_tile.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "core/tasks.hpp"
#include "shared/noise_functions.h"
#include "tests/reference/noise.hpp"

namespace brume::smoke {
namespace {

// Bounds of rounding, with u = kRound the largest relative error of an operation. Hashes, gradients before
// normalization and the place in a lattice cell less its corner are exact; the point is off by u times the
// cells along each axis.
constexpr double kRound = 0x1p-24;

/// Offsets to the features are off by the rounding of three numbers of at most `cells` + 1, distances by the
/// length of that and a relative 3u.
double worley_bound(int cells) {
  return (std::sqrt(3.0) * (2 * cells + 3) + 4) * kRound;
}

/// The polynomial of the weights is off by 43u, so the eight weights together by 3 axes x 2 x 44u + 2u, times
/// ramps of at most sqrt(3): 461u. Ramps are off by 15u, the sum by 16u. The noise changes by at most 7.5 a
/// cell along an axis.
double perlin_bound(int cells) {
  return (492 + 3 * 7.5 * cells) * kRound;
}

/// Per derivative: weights off by 271u, slopes by 2 sqrt(3) x 19u, ramps times slopes by 3.75 x 15u, slopes
/// times weights along the other axes by 3.75 sqrt(3) x 176u, the sum by 60u; and second derivatives of at
/// most 27.5 along an axis and 32 across. The reference's differences are off by less than 1e-6.
double curl_bound(int cells) {
  return 2 * (1600 + (27.5 + 2 * 32) * cells) * kRound + 1e-6;
}

/// The steepest slope of a logistic curve; constants, exponential and divisions are off by 10u in all.
double spread_bound(double bound, double deviation) {
  return 1.702 / (4 * deviation) * bound + 10 * kRound;
}

std::vector<glm::vec3> random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<glm::vec3> points(count);
  for (glm::vec3& p : points) p = {unit(random), unit(random), unit(random)};
  return points;
}

TEST(NoiseFunctions, EqualTheReference) {
  for (const int cells : {1, 2, 7})
    for (const glm::vec3 point : random_points(100, 1)) {
      const glm::dvec3 p(point);
      EXPECT_NEAR(shared::worley(point, cells, 5), reference::worley(p, cells, 5), worley_bound(cells));
      EXPECT_NEAR(shared::perlin(point, cells, 5).w, reference::perlin(p, cells, 5), perlin_bound(cells));
      const glm::vec3 curl = shared::curl_noise(point, cells, 5);
      const glm::dvec3 expected = reference::curl_noise(p, cells, 5);
      for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(curl[axis], expected[axis], curl_bound(cells));
    }
}

TEST(NoiseFunctions, RepeatOverTheUnitCube) {
  for (glm::vec3 p : random_points(100, 4)) {
    p = glm::floor(p * 64.0f) / 64.0f;  // so that moving by whole tiles rounds nothing
    const glm::vec3 moved = p + glm::vec3(-1, 2, -3);
    EXPECT_EQ(shared::worley(p, 5, 8), shared::worley(moved, 5, 8));
    EXPECT_EQ(shared::perlin(p, 5, 8), shared::perlin(moved, 5, 8));
  }
}

TEST(NoiseTile, EqualsTheReference) {
  using namespace reference;
  for (const std::uint32_t size : {1u, 8u}) {
    const NoiseTile tile = make_noise_tile({size, 2, 5});
    ASSERT_EQ(tile.size, size);
    ASSERT_EQ(tile.texels.size(), std::size_t{size} * size * size);
    for (std::uint32_t i = 0; i < tile.texels.size(); ++i) {
      const glm::dvec3 p =
          (glm::dvec3(i % size, i / size % size, i / (size * size)) + 0.5) / static_cast<double>(size);
      const double expected[] = {spread(perlin_worley(p, 2, 3, 5), 0.860, 0.061),
                                 spread(worley_octaves(p, 6, 2, 5 + 64), 0.477, 0.129),
                                 spread(threads(p, 4, 2, 5 + 128), 0.845, 0.082),
                                 spread(perlin_octaves(p, 1, 2, 5 + 192), 0, 0.143)};
      // A mean of octaves is off by no more than its finest, and 5u; the square of cellular noise by twice as
      // much.
      const double bounds[] = {spread_bound(0.5 * perlin_bound(8) + 2 * worley_bound(8) + 20 * kRound, 0.061),
                               spread_bound(worley_bound(12) + 5 * kRound, 0.129),
                               spread_bound(perlin_bound(8) + 5 * kRound, 0.082),
                               spread_bound(perlin_bound(2) + 5 * kRound, 0.143)};
      for (int k = 0; k < 4; ++k)
        EXPECT_NEAR(tile.texels[i][k], 255 * expected[k], 0.5 + 255 * bounds[k]) << i << " " << k;
    }
  }
}

TEST(NoiseTile, IsTheSameOnAnyNumberOfThreads) {
  set_thread_count(1);
  const NoiseTile one = make_noise_tile({16, 2, 3});
  set_thread_count(2);
  const NoiseTile two = make_noise_tile({16, 2, 3});
  set_thread_count(0);
  EXPECT_EQ(one.texels, two.texels);
  EXPECT_NE(one.texels, make_noise_tile({16, 2, 4}).texels);
}

/// Between the centres of the eight texels around a point, in double precision.
glm::dvec4 linear(const NoiseTile& tile, glm::dvec3 p_tile) {
  const glm::dvec3 p = p_tile * static_cast<double>(tile.size) - 0.5, low = glm::floor(p);
  const auto size = static_cast<int>(tile.size);
  glm::dvec4 sum(0);
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 corner(i & 1, i >> 1 & 1, i >> 2);
    const glm::ivec3 at = ((glm::ivec3(low) + corner) % size + size) % size;
    const glm::dvec3 share = 1.0 - glm::abs(p - low - glm::dvec3(corner));
    const auto texel = static_cast<std::size_t>(at.x + size * (at.y + size * at.z));
    sum += share.x * share.y * share.z * glm::dvec4(tile.texels[texel]);
  }
  return sum / 255.0;
}

TEST(NoiseAt, IsLinearBetweenTexelsAndRepeats) {
  for (const std::uint32_t size : {1u, 2u, 16u}) {
    const NoiseTile tile = make_noise_tile({size, 2, 9});
    for (const glm::vec3 unit : random_points(500, 7)) {
      const glm::vec3 p = 6.0f * unit - 3.0f;
      const glm::vec4 noise = noise_at(tile, p);
      const glm::dvec4 expected = linear(tile, glm::dvec3(p));
      // The point is off by u of at most 3 tiles along each axis, and a texel further the noise may differ
      // by 1. Each of the three blends rounds thrice, the scale twice.
      for (int k = 0; k < 4; ++k) EXPECT_NEAR(noise[k], expected[k], (3 * 3 * size + 11) * kRound);
      const glm::vec3 exact = glm::floor(p * 64.0f) / 64.0f;
      EXPECT_EQ(noise_at(tile, exact), noise_at(tile, exact + glm::vec3(5, -8, 1)));
    }
  }
}

TEST(NoiseAt, IsTheTexelAtItsCentre) {
  constexpr std::uint32_t kSize = 8;
  const NoiseTile tile = make_noise_tile({kSize, 2, 9});
  for (std::uint32_t i = 0; i < tile.texels.size(); ++i) {
    const glm::uvec3 texel(i % kSize, i / kSize % kSize, i / (kSize * kSize));
    const glm::vec4 noise = noise_at(tile, (glm::vec3(texel) + 0.5f) / float{kSize});
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(255 * noise[k], tile.texels[i][k], 255 * 3 * kRound);
  }
}

}  // namespace
}  // namespace brume::smoke
