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
                                       std::uint32_t tone = shared::kToneNeutral, float dither = 1) {
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
        [&](gpu::Recorder& recorder) { pass.record(recorder, frame_buffer, noise, image, display, dither); });
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

/// A slow ramp, 4,096 pixels wide and a tile of the noise high, as 8 bits show it.
class GreyRampTest : public DisplayTest {
 protected:
  static constexpr glm::uvec2 kSize{4096, 64};
  GreyRampTest() {
    for (std::uint32_t i = 0; i < kSize.x * kSize.y; ++i)
      radiance_.push_back(to_half(glm::vec4(0.05f + 0.4f * static_cast<float>(i % kSize.x) / kSize.x)));
  }
  std::vector<glm::u8vec4> show_ramp(float dither) const {
    return show(kSize, radiance_, 1, shared::kToneNeutral, dither);
  }
  /// What a column is to show, in steps of 8 bits.
  double expected(std::uint32_t x) const {
    return shown_grey(static_cast<double>(from_half(radiance_[x]).x));
  }
  /// How far the mean of a window of columns is from it, of the channel that is farthest.
  double off(const std::vector<glm::u8vec4>& shown, std::uint32_t first, std::uint32_t columns) const {
    glm::dvec3 mean(0);
    for (std::uint32_t x = first; x < first + columns; ++x)
      for (std::uint32_t y = 0; y < kSize.y; ++y)
        mean += (glm::dvec3(glm::vec3(shown[y * kSize.x + x])) - expected(x)) / double(columns * kSize.y);
    return std::max({std::abs(mean.x), std::abs(mean.y), std::abs(mean.z)});
  }
  /// Of the windows of so many columns, that which is farthest off.
  double farthest_off(const std::vector<glm::u8vec4>& shown, std::uint32_t columns) const {
    double farthest = 0;
    for (std::uint32_t x = 0; x + columns <= kSize.x; x += columns)
      farthest = std::max(farthest, off(shown, x, columns));
    return farthest;
  }
  /// The most columns beside each other in which all pixels have the same value.
  static std::uint32_t widest_band(const std::vector<glm::u8vec4>& shown) {
    std::uint32_t widest = 0, first = 0;
    for (std::uint32_t x = 0; x < kSize.x; ++x) {
      bool is_even = true;
      for (std::uint32_t y = 0; y < kSize.y; ++y) is_even = is_even && shown[y * kSize.x + x] == shown[x];
      if (!is_even) {
        first = x + 1;
        continue;
      }
      if (shown[x] != shown[first]) first = x;
      widest = std::max(widest, x + 1 - first);
    }
    return widest;
  }
  /// How wide the widest step of 8 bits is, in pixels.
  double widest_step() const {
    double widest = 0;
    for (std::uint32_t x = 64; x < kSize.x; x += 64)
      widest = std::max(widest, 64 / (expected(x) - expected(x - 64)));
    return widest;
  }

 private:
  std::vector<Half4> radiance_;
};

TEST_F(GreyRampTest, ShowsNoBand) {
  const auto shown = show_ramp(1);
  // Noise of a whole step, evenly distributed, has no bias; what is left of 1,024 samples of blue noise is
  // below a twentieth of a step. A column has 64 of white noise at worst, of a deviation of at most half a
  // step: four standard errors are a quarter of a step.
  EXPECT_LT(farthest_off(shown, 16), 0.05 + kStoreError);
  EXPECT_LT(farthest_off(shown, 1), 0.25 + kStoreError);
  // A column d pixels from where the ramp is a whole number, in steps of w pixels, is even with the
  // probability (1 - d / w)^64 at most. For all up to d = m on both sides that is about exp(-64 m^2 / w):
  // e^-30 here.
  EXPECT_LT(widest_band(shown), 2 * std::sqrt(30 * widest_step() / 64) + 1);
}

TEST_F(GreyRampTest, HasBandsWithoutNoise) {
  const auto shown = show_ramp(0);
  // As wide as the steps, less what half floats round; up to half a step off at their edges, less a window's
  // width.
  EXPECT_GT(widest_band(shown), 0.9 * widest_step());
  EXPECT_GT(farthest_off(shown, 16), 0.5 - 16 / widest_step());
  EXPECT_GT(farthest_off(shown, 1), 0.4);
  // Some noise does not do.
  EXPECT_GT(farthest_off(show_ramp(0.25f), 16), 0.1);
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
