// shared/erosion.h: what noise leaves of smoke.
#include <array>
#include <random>

#include "brume_test_shaders.hpp"
#include "passes/noise.hpp"
#include "smoke/noise_tile.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/probes.h"

namespace brume::passes {
namespace {

class ErosionTest : public gpu::GpuTest {
 protected:
  std::vector<float> erode(const gpu::Buffer& noises, std::size_t count, float density, float erosion) {
    struct Impulse {
      float density, erosion;
    };
    const gpu::Buffer out(context(), count * sizeof(float),
                          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
    runner().run([&](gpu::Recorder& recorder) {
      recorder.bind(probe_,
                    {{shared::kBindProbeIn, gpu::read(noises)}, {shared::kBindProbeOut, gpu::write(out)}},
                    Impulse{density, erosion});
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
  for (const float erosion : {0.0f, 0.3f, 0.8f, 1.0f}) {
    std::vector<float> before(noises.size(), 0.0f);
    for (int d = 0; d <= 32; ++d) {
      const auto left = erode(buffer, noises.size(), static_cast<float>(d) / 32, erosion);
      for (std::size_t i = 0; i < noises.size(); ++i) {
        EXPECT_TRUE(d > 0 || left[i] == 0.0f);
        EXPECT_GE(left[i], before[i] - 1e-5f) << erosion << " " << d << " " << i;
        EXPECT_LE(left[i], 1 + 0.5f * erosion + 1e-5f);
      }
      before = left;
    }
  }
}

TEST_F(ErosionTest, RisesWithEachChannel) {
  const auto noises = random_noises();
  for (int channel = 0; channel < 4; ++channel) {
    auto brighter = noises;
    for (glm::vec4& one : brighter) one[channel] = std::min(one[channel] + 0.1f, 1.0f);
    const auto buffer = upload(noises), brighter_buffer = upload(brighter);
    for (const float density : {0.1f, 0.4f, 0.7f, 1.0f}) {
      const auto left = erode(buffer, noises.size(), density, 0.8f);
      const auto more = erode(brighter_buffer, noises.size(), density, 0.8f);
      for (std::size_t i = 0; i < noises.size(); ++i) EXPECT_GE(more[i], left[i] - 1e-5f) << channel;
    }
  }
}

TEST_F(ErosionTest, NoErosionLeavesAllThatIsDense) {
  const auto noises = random_noises();
  for (const float left : erode(upload(noises), noises.size(), 1, 0)) EXPECT_EQ(left, 1.0f);
}

// Line of sight knows no noise: in the mean the noise leaves dense smoke as it is, and of a rim about as much
// as there is.
TEST_F(ErosionTest, KeepsTheMeanDensity) {
  const auto noises = smoke_noises();
  const auto buffer = upload(noises);
  const auto mean = [&](float density, float erosion) {
    double sum = 0;
    for (const float left : erode(buffer, noises.size(), density, erosion)) sum += static_cast<double>(left);
    return sum / static_cast<double>(noises.size());
  };
  for (const float erosion : {0.3f, 0.5f, 0.8f, 1.0f})
    for (const float density : {0.9f, 0.95f, 1.0f})
      EXPECT_NEAR(mean(density, erosion) / static_cast<double>(density), 1, 0.15)
          << erosion << " " << density;
  // A line through a rim, its density rising evenly.
  double before = 0, after = 0;
  for (int i = 1; i <= 16; ++i) {
    before += i / 16.0;
    after += mean(static_cast<float>(i) / 16, 0.8f);
  }
  EXPECT_NEAR(after / before, 1, 0.15);
  RecordProperty("rim_share", std::to_string(after / before));
}

}  // namespace
}  // namespace brume::passes
