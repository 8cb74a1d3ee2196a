#include "passes/worley.hpp"

#include <cmath>

#include "tests/gpu/gpu_test.hpp"

namespace brume::passes {
namespace {

using gpu::GpuTest;

// The reference: the same noise in double precision with its own loops.
glm::uvec3 pcg3d(glm::uvec3 v) {
  v = v * 1664525u + 1013904223u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  v ^= v >> 16u;
  v.x += v.y * v.z;
  v.y += v.z * v.x;
  v.z += v.x * v.y;
  return v;
}

double nearest_feature(glm::dvec3 p, int cells, std::uint32_t seed) {
  double nearest = 1e9;
  for (int z = 0; z < cells; ++z)
    for (int y = 0; y < cells; ++y)
      for (int x = 0; x < cells; ++x) {
        const glm::uvec3 hash = pcg3d(glm::uvec3(x, y, z) + glm::uvec3(seed, seed * 3u, seed * 7u)) >> 8u;
        const glm::dvec3 feature = glm::dvec3(x, y, z) + glm::dvec3(hash) / 16777216.0;
        glm::dvec3 apart = glm::abs(feature - p * static_cast<double>(cells));
        apart = glm::min(apart, static_cast<double>(cells) - apart);  // over the edge of the torus
        nearest = std::min(nearest, glm::length(apart));
      }
  return nearest;
}

double billows(glm::dvec3 p, int cells, std::uint32_t octaves, std::uint32_t seed) {
  double sum = 0, total = 0;
  for (std::uint32_t octave = 0; octave < octaves; ++octave) {
    const double weight = std::pow(0.5, octave);
    sum += weight * std::max(0.0, 1.0 - nearest_feature(p, cells << octave, seed + octave));
    total += weight;
  }
  return sum / total;
}

std::vector<std::uint8_t> make_tile(gpu::Context& context, gpu::CommandRunner& runner,
                                    const shared::WorleyParams& params, auto read_back) {
  const WorleyPass pass(context);
  const gpu::Image tile = make_worley_tile(context, params.size);
  runner.run([&](gpu::Recorder& recorder) { pass.record(recorder, tile, params); });
  return read_back(tile);
}

class WorleyTest : public GpuTest {
 protected:
  static std::vector<std::uint8_t> tile(const shared::WorleyParams& params) {
    return make_tile(context(), runner(), params, [](const gpu::Image& image) {
      std::vector<std::uint8_t> bytes;
      for (const std::uint16_t texel : read_back<std::uint16_t>(image)) {
        bytes.push_back(static_cast<std::uint8_t>(texel & 255));
        bytes.push_back(static_cast<std::uint8_t>(texel >> 8));
      }
      return bytes;
    });
  }
};

TEST_F(WorleyTest, EqualsTheReference) {
  for (const std::uint32_t size : {1u, 7u, 16u}) {
    const shared::WorleyParams params{size, 2, 2, 5};
    const auto bytes = tile(params);
    ASSERT_EQ(bytes.size(), 2u * size * size * size);
    for (std::uint32_t i = 0; i < size * size * size; ++i) {
      const glm::dvec3 p =
          (glm::dvec3(i % size, i / size % size, i / (size * size)) + 0.5) / static_cast<double>(size);
      // Rounding to 8 bits, and float arithmetic below a thousandth of a step.
      EXPECT_NEAR(bytes[2 * i], 255 * billows(p, 2, 2, 5), 0.51);
      EXPECT_NEAR(bytes[2 * i + 1], 255 * billows(p, 6, 2, 5 + 101), 0.51);
    }
  }
}

TEST_F(WorleyTest, TilesWithoutASeam) {
  constexpr std::uint32_t kSize = 24;
  const auto bytes = tile({kSize, 2, 1, 9});
  const auto at = [&](std::uint32_t x, std::uint32_t y, std::uint32_t z) {
    return static_cast<int>(bytes[2 * (x % kSize + kSize * (y % kSize + kSize * (z % kSize)))]);
  };
  // Distance changes by at most one texel's width from texel to texel, over the seam as anywhere.
  const double most = 255.0 * 2 / kSize + 1;
  for (std::uint32_t a = 0; a < kSize; ++a)
    for (std::uint32_t b = 0; b < kSize; ++b) {
      EXPECT_LE(std::abs(at(kSize - 1, a, b) - at(kSize, a, b)), most);
      EXPECT_LE(std::abs(at(a, kSize - 1, b) - at(a, kSize, b)), most);
      EXPECT_LE(std::abs(at(a, b, kSize - 1) - at(a, b, kSize)), most);
    }
}

TEST_F(WorleyTest, FollowsItsSeed) {
  EXPECT_EQ(tile({8, 2, 2, 1}), tile({8, 2, 2, 1}));
  EXPECT_NE(tile({8, 2, 2, 1}), tile({8, 2, 2, 2}));
}

}  // namespace
}  // namespace brume::passes
