#include "passes/noise.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

#include "brume_test_shaders.hpp"
#include "smoke/noise_tile.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/probes.h"
#include "tests/reference/noise.hpp"

namespace brume::passes {
namespace {

using gpu::GpuTest;
using Texel = std::array<std::uint8_t, 4>;

std::vector<glm::vec3> random_points(std::size_t count, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> unit(0, 1);
  std::vector<glm::vec3> points(count);
  for (glm::vec3& p : points) p = {unit(random), unit(random), unit(random)};
  return points;
}

/// The noise of shaders/shared/noise_functions.h at points.
class NoiseKinds : public GpuTest {
 protected:
  struct Values {
    float worley, perlin;
    glm::vec3 gradient, curl;
    float perlin_worley, threads;
  };
  static_assert(sizeof(Values) == 40);

  std::vector<Values> at(const std::vector<glm::vec3>& points, int cells, std::uint32_t seed) {
    struct Impulse {
      int cells;
      std::uint32_t seed;
    };
    const auto in = upload(points);
    const gpu::Buffer out(context(), points.size() * sizeof(Values),
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    runner().run([&](gpu::Recorder& recorder) {
      recorder.bind(probe_, {{shared::kBindProbeIn, gpu::read(in)}, {shared::kBindProbeOut, gpu::write(out)}},
                    Impulse{cells, seed});
      recorder.dispatch_threads(probe_, static_cast<std::uint32_t>(points.size()));
    });
    return read_back<Values>(out, points.size());
  }

 private:
  gpu::ComputePipeline probe_{context(), shaders::noise_probe_comp};
};

TEST_F(NoiseKinds, EqualTheReference) {
  const auto points = random_points(100, 1);
  for (const int cells : {1, 2, 7}) {
    const auto values = at(points, cells, 5);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const glm::dvec3 p(points[i]);
      const Values& v = values[i];
      // Floats of magnitude 10 in, a few dozen operations each.
      EXPECT_NEAR(v.worley, reference::worley(p, cells, 5), 2e-5);
      EXPECT_NEAR(v.perlin, reference::perlin(p, cells, 5), 2e-5);
      const glm::dvec3 gradient = reference::perlin_gradient(p, cells, 5);
      const glm::dvec3 curl = reference::curl_noise(p, cells, 5);
      for (int axis = 0; axis < 3; ++axis) {
        EXPECT_NEAR(v.gradient[axis], gradient[axis], 2e-4);
        EXPECT_NEAR(v.curl[axis], curl[axis], 4e-4);
      }
      EXPECT_NEAR(v.perlin_worley, reference::perlin_worley(p, cells, 2, 5), 2e-5);
      EXPECT_NEAR(v.threads, reference::threads(p, cells, 2, 5), 2e-5);
    }
  }
}

TEST_F(NoiseKinds, KeepTheirRangesAndMeans) {
  const auto values = at(random_points(20000, 2), 64, 3);
  double perlin = 0;
  glm::dvec3 curl(0);
  for (const Values& v : values) {
    perlin += static_cast<double>(v.perlin);
    curl += glm::dvec3(v.curl);
    for (const float one : {v.worley, v.perlin_worley, v.threads}) {
      EXPECT_GE(one, 0.0f);
      EXPECT_LE(one, 1.0f);
    }
    EXPECT_LE(std::abs(v.perlin), std::sqrt(0.75f));
  }
  // Five standard errors: deviations of 0.19 and, by component, 0.71.
  const double n = static_cast<double>(values.size());
  EXPECT_NEAR(perlin / n, 0, 5 * 0.19 / std::sqrt(n));
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(curl[axis] / n, 0, 5 * 0.71 / std::sqrt(n));
}

TEST_F(NoiseKinds, RepeatOverTheUnitCube) {
  std::vector<glm::vec3> points;  // in 1/64, so that moving by whole tiles rounds nothing
  for (const glm::vec3 p : random_points(200, 4)) points.push_back(glm::floor(p * 64.0f) / 64.0f);
  std::vector<glm::vec3> moved;
  for (std::size_t i = 0; i < points.size(); ++i)
    moved.push_back(points[i] + glm::vec3(static_cast<int>(i % 3) - 1, 2, -3));
  const auto here = at(points, 5, 8), there = at(moved, 5, 8);
  EXPECT_EQ(std::memcmp(here.data(), there.data(), here.size() * sizeof(Values)), 0);
}

TEST_F(NoiseKinds, CurlHasNoDivergence) {
  constexpr int kCells = 3;
  constexpr float kStep = 1.0f / 128;  // cells
  std::vector<glm::vec3> points;
  for (const glm::vec3 p : random_points(300, 6))
    for (int side = 0; side < 6; ++side) {
      glm::vec3 d(0);
      d[side / 2] = side % 2 == 0 ? kStep / kCells : -kStep / kCells;
      points.push_back(p + d);
    }
  const auto values = at(points, kCells, 12);
  double divergence = 0, slope = 0;
  for (std::size_t i = 0; i < values.size(); i += 6)
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = i + 2 * static_cast<std::size_t>(axis);
      const glm::dvec3 change = glm::dvec3(values[k].curl - values[k + 1].curl) / (2.0 * kStep);
      slope += glm::dot(change, change);
      double sum = 0;
      if (axis == 0)
        for (int a = 0; a < 3; ++a) {
          const auto j = i + 2 * static_cast<std::size_t>(a);
          sum += static_cast<double>(values[j].curl[a] - values[j + 1].curl[a]) / (2.0 * kStep);
        }
      divergence += sum * sum;
    }
  // Central differences leave a fraction of step^2 of the third derivative, and rounding.
  EXPECT_LT(std::sqrt(divergence), 0.01 * std::sqrt(slope));
}

class NoiseTile : public GpuTest {
 protected:
  std::vector<Texel> make(const shared::NoiseParams& params) {
    const gpu::Image tile = make_noise_tile(context(), params.size);
    runner().run([&](gpu::Recorder& recorder) { pass_.record(recorder, tile, params); });
    return read_back<Texel>(tile);
  }
  NoisePass pass_{context()};
};

TEST_F(NoiseTile, EqualsTheReference) {
  using namespace reference;
  for (const std::uint32_t size : {1u, 7u}) {
    const auto tile = make({size, 2, 5});
    ASSERT_EQ(tile.size(), std::size_t{size} * size * size);
    for (std::uint32_t i = 0; i < tile.size(); ++i) {
      const glm::dvec3 p =
          (glm::dvec3(i % size, i / size % size, i / (size * size)) + 0.5) / static_cast<double>(size);
      const double expected[] = {reference::spread(perlin_worley(p, 2, 3, 5), 0.860, 0.061),
                                 reference::spread(worley_octaves(p, 6, 2, 5 + 64), 0.477, 0.129),
                                 reference::spread(threads(p, 4, 2, 5 + 128), 0.845, 0.082),
                                 reference::spread(perlin_octaves(p, 1, 2, 5 + 192), 0, 0.143)};
      // Rounding to 8 bits, and float arithmetic of at most 255 x 2e-5 x the steepest slope of `spread`, 6.5.
      for (std::size_t k = 0; k < 4; ++k)
        EXPECT_NEAR(tile[i][k], 255 * expected[k], 0.5 + kStoreError + 0.04) << i << " " << k;
    }
  }
}

TEST_F(NoiseTile, IsThatOfTheProcessor) {
  for (const shared::NoiseParams& params : {smoke::kSmokeNoise, shared::NoiseParams{7, 2, 5}}) {
    const auto device = make(params);
    const smoke::NoiseTile tile = smoke::make_noise_tile(params);
    ASSERT_EQ(device.size(), tile.texels.size());
    // Numbers that are next to each other may be rounded apart, by one step of 8 bits.
    for (std::size_t i = 0; i < device.size(); ++i)
      for (int k = 0; k < 4; ++k)
        EXPECT_LE(std::abs(int{device[i][static_cast<std::size_t>(k)]} - int{tile.texels[i][k]}), 1) << i;
  }
}

TEST_F(NoiseTile, HasTheDetailOfTheProcessor) {
  const NoisePass pass(context());
  const gpu::Image tile = make_noise_tile(context(), smoke::kSmokeNoise.size);
  const gpu::Image detail = make_detail_tile(context());
  runner().run([&](gpu::Recorder& recorder) {
    pass.record(recorder, tile, smoke::kSmokeNoise);
    pass.record_detail(recorder, tile, detail);
  });
  const auto expected = smoke::make_detail_tile(smoke::make_noise_tile(smoke::kSmokeNoise));
  const auto found = read_back<std::array<std::uint8_t, 2>>(detail);
  ASSERT_EQ(found.size(), expected.texels.size());
  int most = 0;
  for (std::size_t i = 0; i < found.size(); ++i)
    for (int c = 0; c < 2; ++c)
      most =
          std::max(most, std::abs(int{found[i][static_cast<std::size_t>(c)]} - int{expected.texels[i][c]}));
  // A texel of noise may round otherwise, its weights are of 8 bits, and the slopes of both are up to 1.35.
  EXPECT_LE(most, 4);
}

TEST_F(NoiseTile, TilesWithoutASeam) {
  constexpr std::uint32_t kSize = 48;
  const auto tile = make({kSize, 2, 9});
  const auto at = [&](glm::uvec3 p) {
    p %= kSize;
    return tile[p.x + kSize * (p.y + kSize * p.z)];
  };
  // No step over the seam is higher than the highest one elsewhere, up to rounding.
  for (int axis = 0; axis < 3; ++axis)
    for (std::size_t channel = 0; channel < 4; ++channel) {
      int seam = 0, inside = 0;
      for (std::uint32_t i = 0; i < kSize * kSize * kSize; ++i) {
        const glm::uvec3 p(i % kSize, i / kSize % kSize, i / (kSize * kSize));
        glm::uvec3 next = p;
        ++next[axis];
        int& most = p[axis] == kSize - 1 ? seam : inside;
        most = std::max(most, std::abs(at(p)[channel] - at(next)[channel]));
      }
      EXPECT_LE(seam, inside + 1) << axis << " " << channel;
      EXPECT_LT(inside, 200) << "steps so high that they say nothing";
    }
}

TEST_F(NoiseTile, IsSpreadOverItsRange) {
  const auto tile = make(smoke::kSmokeNoise);
  for (std::size_t channel = 0; channel < 4; ++channel) {
    std::vector<std::uint8_t> values;
    for (const Texel& texel : tile) values.push_back(texel[channel]);
    std::sort(values.begin(), values.end());
    const auto quantile = [&](double share) {
      return values[static_cast<std::size_t>(share * static_cast<double>(values.size()))] / 255.0;
    };
    for (const double share : {0.25, 0.5, 0.75}) EXPECT_NEAR(quantile(share), share, 0.1) << channel;
  }
}

TEST_F(NoiseTile, FollowsItsSeed) {
  EXPECT_EQ(make({8, 2, 1}), make({8, 2, 1}));
  EXPECT_NE(make({8, 2, 1}), make({8, 2, 2}));
}

}  // namespace
}  // namespace brume::passes
