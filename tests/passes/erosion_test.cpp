// shared/erosion.h: what noise leaves of smoke.
#include <array>
#include <random>

#include "brume_test_shaders.hpp"
#include "passes/noise.hpp"
#include "shared/erosion.h"
#include "smoke/noise_tile.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/probes.h"

namespace brume::passes {
namespace {

class ErosionTest : public gpu::GpuTest {
 protected:
  std::vector<float> erode(const gpu::Buffer& noises, std::size_t count, float density, float erosion,
                           float detail) {
    struct Parameters {
      float density, erosion, detail;
    };
    const gpu::Buffer out(context(), count * sizeof(float),
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    runner().run([&](gpu::Recorder& recorder) {
      recorder.bind(probe_,
                    {{shared::kBindProbeIn, gpu::read(noises)}, {shared::kBindProbeOut, gpu::write(out)}},
                    Parameters{density, erosion, detail});
      recorder.dispatch_threads(probe_, static_cast<std::uint32_t>(count));
    });
    return read_back<float>(out, count);
  }
  /// The texels of the tile that smoke is eroded with.
  static std::vector<glm::vec4> smoke_noises() {
    const NoisePass pass(context());
    const gpu::Image tile = make_noise_tile(context(), smoke::kSmokeNoise.size);
    runner().run([&](gpu::Recorder& recorder) { pass.record(recorder, tile, smoke::kSmokeNoise); });
    std::vector<glm::vec4> noises;
    for (const auto& texel : read_back<std::array<std::uint8_t, 4>>(tile))
      noises.push_back(glm::vec4(texel[0], texel[1], texel[2], texel[3]) / 255.0f);
    return noises;
  }
  static std::vector<glm::vec4> random_noises() {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> unit(0, 1);
    std::vector<glm::vec4> noises(500);
    for (glm::vec4& one : noises) one = {unit(random), unit(random), unit(random), unit(random)};
    return noises;
  }

 private:
  gpu::ComputePipeline probe_{context(), shaders::erosion_probe_comp};
};

TEST_F(ErosionTest, RisesWithDensityFromNothing) {
  const auto noises = random_noises();
  const auto buffer = upload(noises);
  for (const float detail : {0.0f, 0.5f, 1.0f}) {
    for (const float erosion : {0.0f, 0.3f, 0.8f, 1.0f}) {
      std::vector<float> before(noises.size(), 0.0f);
      for (int d = 0; d <= 32; ++d) {
        const auto left = erode(buffer, noises.size(), static_cast<float>(d) / 32, erosion, detail);
        for (std::size_t i = 0; i < noises.size(); ++i) {
          EXPECT_TRUE(d > 0 || left[i] == 0.0f);
          EXPECT_GE(left[i], before[i] - 1e-5f) << erosion << " " << d << " " << i;
          EXPECT_LE(left[i], 1 + 0.5f * erosion + 1e-5f);
        }
        before = left;
      }
    }
  }
}

TEST_F(ErosionTest, RisesWithEachChannel) {
  const auto noises = random_noises();
  for (int channel = 0; channel < 4; ++channel) {
    auto brighter = noises;
    for (glm::vec4& one : brighter) one[channel] = std::min(one[channel] + 0.1f, 1.0f);
    const auto buffer = upload(noises), brighter_buffer = upload(brighter);
    for (const float detail : {0.0f, 1.0f}) {
      for (const float density : {0.1f, 0.4f, 0.7f, 1.0f}) {
        const auto left = erode(buffer, noises.size(), density, 0.8f, detail);
        const auto more = erode(brighter_buffer, noises.size(), density, 0.8f, detail);
        for (std::size_t i = 0; i < noises.size(); ++i) EXPECT_GE(more[i], left[i] - 1e-5f) << channel;
      }
    }
  }
}

TEST_F(ErosionTest, NoErosionLeavesAllThatIsDense) {
  const auto noises = random_noises();
  for (const float detail : {0.0f, 1.0f})
    for (const float left : erode(upload(noises), noises.size(), 1, 0, detail)) EXPECT_EQ(left, 1.0f);
}

/// Adds detail to each noise of the tile, sampled at random places.
std::vector<glm::vec4> with_detail(const std::vector<glm::vec4>& noises, float detail) {
  shared::SmokeLook look{};
  look.detail = detail;
  std::mt19937 random(11);
  std::uniform_int_distribution<std::size_t> any(0, noises.size() - 1);
  std::vector<glm::vec4> all;
  for (const glm::vec4& noise : noises)
    all.push_back(shared::with_detail(noise, noises[any(random)], noises[any(random)],
                                      shared::detail_weights(look, 0)));
  return all;
}

// Line of sight knows no noise: in the mean the noise leaves dense smoke as it is, and of a rim about as much
// as there is.
TEST_F(ErosionTest, KeepsTheMeanDensity) {
  const auto tile = smoke_noises();
  for (const float detail : {0.0f, 0.5f, 1.0f}) {
    const auto noises = with_detail(tile, detail);
    const auto buffer = upload(noises);
    const auto mean = [&](float density, float erosion) {
      double sum = 0;
      for (const float left : erode(buffer, noises.size(), density, erosion, detail)) sum += double{left};
      return sum / static_cast<double>(noises.size());
    };
    for (const float erosion : {0.3f, 0.5f, 0.8f, 1.0f})
      for (const float density : {0.9f, 0.95f, 1.0f})
        EXPECT_NEAR(mean(density, erosion) / double{density}, 1, 0.15)
            << detail << " " << erosion << " " << density;
    // A line through a rim, its density rising evenly.
    double before = 0, after = 0;
    for (int i = 1; i <= 16; ++i) {
      before += i / 16.0;
      after += mean(static_cast<float>(i) / 16, 0.8f);
    }
    EXPECT_NEAR(after / before, 1, 0.15) << detail;
    std::printf("detail %.1f: %.3f of a rim remains; of densities 0.1 to 1:", double{detail}, after / before);
    for (int i = 1; i <= 10; ++i) std::printf(" %.2f", mean(static_cast<float>(i) / 10, 0.8f));
    std::printf("\n");
  }
}

TEST_F(ErosionTest, DetailMattersWhereverItChangesWhatRemains) {
  const auto noises = random_noises();
  std::mt19937 random(5);
  std::uniform_int_distribution<std::size_t> any(0, noises.size() - 1);
  int left_out = 0, changed = 0;
  for (const float detail : {0.3f, 1.0f}) {
    shared::SmokeLook look{};
    look.erosion = 0.8f;
    look.detail = detail;
    const glm::vec2 weights = shared::detail_weights(look, 0);
    for (int i = 0; i < 20000; ++i) {
      const glm::vec4 noise = noises[any(random)];
      const float density = static_cast<float>(i % 101) / 100;
      const float without = shared::erode(look, density, noise, noise);
      const glm::vec4 detailed =
          shared::with_detail(noise, noises[any(random)], noises[any(random)], weights);
      const float with = shared::erode(look, density, noise, detailed);
      if (shared::detail_matters(look, density, noise, weights)) {
        changed += with != without;
      } else {
        ++left_out;
        EXPECT_EQ(with, without);
      }
    }
    EXPECT_FALSE(shared::detail_matters(look, 0.5f, glm::vec4(0.5f), glm::vec2(0)));
  }
  EXPECT_GT(left_out, 10000);
  EXPECT_GT(changed, 5000);
}

TEST_F(ErosionTest, DetailLeavesTheMeanOfTheNoise) {
  const auto tile = smoke_noises();
  const auto mean = [](const std::vector<glm::vec4>& noises) {
    glm::dvec4 sum(0);
    for (const glm::vec4& noise : noises) sum += glm::dvec4(noise);
    return sum / static_cast<double>(noises.size());
  };
  const auto detailed = with_detail(tile, 1);
  for (const glm::vec4& noise : detailed)
    for (int c = 0; c < 4; ++c) EXPECT_TRUE(noise[c] >= 0 && noise[c] <= 1);
  // Both octaves are around a half, and clamping is nearly symmetric, as the channels cover [0, 1] evenly.
  for (int c = 0; c < 4; ++c) EXPECT_NEAR(mean(detailed)[c], mean(tile)[c], 0.02) << c;
}

TEST_F(ErosionTest, OctavesFadeBeforeTheirCellsAreNarrowerThanPixels) {
  shared::SmokeLook look{};
  look.detail = 1;
  look.noise_frequency = 1.0f / 6;
  glm::vec2 before = shared::detail_weights(look, 0);
  EXPECT_EQ(before, glm::vec2(0.55f, 0.25f));
  for (int i = 1; i <= 400; ++i) {
    const float pixel = 0.0005f * static_cast<float>(i);
    const glm::vec2 weights = shared::detail_weights(look, pixel);
    EXPECT_TRUE(weights.x <= before.x && weights.y <= before.y && weights.y >= 0 && weights.x >= 0);
    // The narrowest billows of an octave, of which a tile has 16.
    const float widths[]{6 / 5.3f / 16, 6 / 17.9f / 16};
    for (int octave = 0; octave < 2; ++octave) {
      const float most = octave == 0 ? 0.55f : 0.25f;
      if (pixel <= 0.5f * widths[octave]) {
        EXPECT_NEAR(weights[octave], most, 1e-5);
      }
      if (pixel >= 1.51f * widths[octave]) {
        EXPECT_EQ(weights[octave], 0);
      }
    }
    before = weights;
  }
}

}  // namespace
}  // namespace brume::passes
