#include "passes/display.hpp"

#include <array>
#include <cmath>

#include "passes/blue_noise.hpp"
#include "shared/frame.h"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/half.hpp"

namespace brume::passes {
namespace {

class DisplayTest : public gpu::GpuTest {
 protected:
  /// What 8 bits show of an image.
  static std::vector<glm::u8vec4> show(glm::uvec2 size, const std::vector<Half4>& radiance, float exposure,
                                       std::uint32_t tone = shared::kToneNeutral) {
    const auto image = upload_image(context(), runner(), size, VK_FORMAT_R16G16B16A16_SFLOAT, radiance);
    const auto display = test_image(context(), size, VK_FORMAT_R8G8B8A8_UNORM);
    shared::FrameConstants frame{};
    frame.size_px = size;
    frame.exposure = exposure;
    frame.tone = tone;
    const auto frame_buffer = upload(std::vector{frame});
    gpu::Image noise;
    runner().run([&](gpu::Recorder& recorder) { noise = make_blue_noise(context(), recorder); });
    const DisplayPass pass(context());
    runner().run(
        [&](gpu::Recorder& recorder) { pass.record(recorder, frame_buffer, noise, image, display); });
    return read_back<glm::u8vec4>(display);
  }
};

/// The reference: Khronos PBR Neutral for grey, then sRGB.
double shown_grey(double x) {
  const double offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
  double c = x - offset;
  if (c >= 0.76) c = 1 - 0.24 * 0.24 / (c + 0.24 - 0.76);
  return 255 * (c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055);
}

TEST_F(DisplayTest, TheStandardCurveIsSrgbAlone) {
  // Blender 3.4 shows (0.02, 0.03, 0.05) as 39 49 64 with its view "Standard".
  constexpr glm::uvec2 kSize{64, 64};
  const std::vector<Half4> radiance(kSize.x * kSize.y, to_half({0.02f, 0.03f, 0.05f, 1}));
  glm::dvec3 mean(0);
  for (const glm::u8vec4& texel : show(kSize, radiance, 1, shared::kToneStandard))
    mean += glm::dvec3(texel) / 4096.0;
  for (int channel = 0; channel < 3; ++channel)
    EXPECT_NEAR(mean[channel], (std::array{38.7, 48.4, 63.1})[static_cast<std::size_t>(channel)], 0.3);
  for (const glm::u8vec4& texel : show({1, 1}, {to_half(glm::vec4(3))}, 1, shared::kToneStandard))
    EXPECT_EQ(texel.x, 255);
}

TEST_F(DisplayTest, AGreyRampShowsNoBand) {
  // A slow ramp, 4,096 pixels wide and a noise tile high: the mean of a small window must follow the ramp far
  // more finely than in steps of 1/255.
  constexpr glm::uvec2 kSize{4096, 64};
  const auto grey = [](double x) { return 0.05 + 0.4 * x / kSize.x; };
  std::vector<Half4> radiance(kSize.x * kSize.y);
  for (std::uint32_t i = 0; i < radiance.size(); ++i)
    radiance[i] = to_half(glm::vec4(static_cast<float>(grey(i % kSize.x))));
  const auto shown = show(kSize, radiance, 1);
  constexpr std::uint32_t kWindow = 16;
  for (std::uint32_t x = 0; x + kWindow <= kSize.x; x += kWindow) {
    glm::dvec3 mean(0);
    double expected = 0;
    for (std::uint32_t i = 0; i < kWindow * kSize.y; ++i) {
      const std::uint32_t at = x + i % kWindow + kSize.x * (i / kWindow);
      mean += glm::dvec3(glm::vec3(shown[at]));
      expected += shown_grey(static_cast<double>(from_half(radiance[at]).x));
    }
    mean /= kWindow * kSize.y;
    expected /= kWindow * kSize.y;
    // Dither of uniform noise: no bias; what is left of 1,024 blue-noise samples is below a twentieth of a
    // step.
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(mean[c], expected, 0.05) << "column " << x;
  }
}

TEST_F(DisplayTest, ExposureMultiplies) {
  constexpr glm::uvec2 kSize{64, 64};
  const std::vector<Half4> dim(64 * 64, to_half(glm::vec4(0.1f))), bright(64 * 64, to_half(glm::vec4(0.2f)));
  const auto a = show(kSize, dim, 2), b = show(kSize, bright, 1);
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_LE(std::abs(a[i].x - b[i].x), 1);
}

TEST_F(DisplayTest, BrightnessNeverFalls) {
  constexpr glm::uvec2 kSize{512, 1};
  std::vector<Half4> radiance(512);
  for (std::uint32_t i = 0; i < 512; ++i)
    radiance[i] = to_half(glm::vec4(static_cast<float>(std::exp2(i / 32.0 - 8))));
  const auto shown = show(kSize, radiance, 1);
  for (std::uint32_t i = 1; i < 512; ++i)
    EXPECT_GE(shown[i].y + 1, shown[i - 1].y);  // the dither may take a step
  EXPECT_GE(shown[511].y, 250);
}

}  // namespace
}  // namespace brume::passes
