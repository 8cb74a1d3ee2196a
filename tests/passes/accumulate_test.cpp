#include "passes/accumulate.hpp"

#include <cmath>
#include <random>

#include "planning/media_plan.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/film_frame.hpp"
#include "tests/passes/half.hpp"

namespace brume::passes {
namespace {

class AccumulateTest : public gpu::GpuTest {
 protected:
  AccumulateTest() : pass_(context(), kFrameSize) {}

  using Texels = std::vector<glm::vec4>;
  static Texels even(glm::vec4 value) { return Texels(kFrameSize.x * kFrameSize.y, value); }

  /// Adds a frame; what is shown of it. Surfaces are `distances` away along the view axis.
  Texels add(shared::FrameConstants frame, const Texels& smoke, const std::vector<float>& distances,
             bool continues) {
    std::vector<Half4> halves;
    for (const glm::vec4& texel : smoke) halves.push_back(to_half(texel));
    std::vector<float> reverse;
    for (const float d : distances) reverse.push_back(0.05f / d);
    const auto image = upload_image(context(), runner(), kFrameSize, VK_FORMAT_R16G16B16A16_SFLOAT, halves);
    const auto depth = upload_image(context(), runner(), kFrameSize, VK_FORMAT_R32_SFLOAT, reverse);
    frame.media = planning::smoke_media(frame.smoke, frame.look);
    const auto buffer = upload(std::vector{frame});
    runner().run([&](gpu::Recorder& r) {
      pass_.record(r, buffer, frame.size_px, depth, image, continues ? past_ : std::nullopt);
    });
    past_ = {planning::seen_from_world(frame.camera), glm::mat4(1), frame.size_px};
    Texels shown;
    shown = from_half(read_back<Half4>(pass_.gathered()));
    return shown;
  }
  static std::vector<float> wall(float distance) {
    return std::vector<float>(kFrameSize.x * kFrameSize.y, distance);
  }

  AccumulatePass pass_;
  std::optional<planning::PastView> past_;
};

TEST_F(AccumulateTest, AFrameWithoutHistoryIsItself) {
  (void)add(frame_at(0), even({0.5f, 0.5f, 0.5f, 0.25f}), wall(12), false);
  Texels random;
  std::mt19937 generator(1);
  for (std::uint32_t i = 0; i < kFrameSize.x * kFrameSize.y; ++i)
    random.push_back(from_half(to_half(glm::vec4(static_cast<float>(generator() % 1000) / 1000))));
  EXPECT_EQ(add(frame_at(0), random, wall(12), false), random);
}

TEST_F(AccumulateTest, WhatStaysTheSameStaysTheSame) {
  const Texels smoke = even(from_half(to_half({0.3f, 0.2f, 0.1f, 0.6f})));
  for (int i = 0; i < 20; ++i) {
    for (const glm::vec4& shown : add(frame_at(0.1f * static_cast<float>(i)), smoke, wall(12), i > 0))
      EXPECT_LT(glm::length(shown - smoke[0]), 0.001f);  // roundings to half floats
  }
}

TEST_F(AccumulateTest, NoiseAveragesOut) {
  // White noise of deviation s around 0.5. A mean of eight has s / sqrt(8) = 0.35 s; clipping to the frame at
  // hand lets a little of its noise back in.
  std::mt19937 generator(2);
  std::normal_distribution<float> noise(0, 0.05f);
  Texels shown;
  for (int i = 0; i < 24; ++i) {
    Texels smoke;
    for (std::uint32_t k = 0; k < kFrameSize.x * kFrameSize.y; ++k)
      smoke.push_back(glm::vec4(0.5f + noise(generator)));
    shown = add(frame_at(0), smoke, wall(12), i > 0);
  }
  double square = 0;
  for (const glm::vec4& texel : shown) square += std::pow(static_cast<double>(texel.a) - 0.5, 2);
  const double deviation = std::sqrt(square / static_cast<double>(shown.size()));
  EXPECT_LT(deviation, 0.6 * 0.05);
}

// Frames of any size up to that of the images, which hold something else beside them: the mean goes on.
TEST_F(AccumulateTest, TheMeanGoesOnWhereTheSizeChanges) {
  std::mt19937 generator(5);
  std::normal_distribution<float> noise(0, 0.05f);
  const Texels other = even(glm::vec4(-1000));
  for (int i = 0; i < 2; ++i) (void)add(frame_at(0), other, wall(12), false);
  Texels shown;
  shared::FrameConstants frame = frame_at(0);
  for (int i = 0; i < 24; ++i) {
    frame.size_px = kFrameSize - glm::uvec2(1 + i % 5, 1 + i % 3);
    Texels smoke = other;
    for (std::uint32_t y = 0; y < frame.size_px.y; ++y)
      for (std::uint32_t x = 0; x < frame.size_px.x; ++x)
        smoke[x + kFrameSize.x * y] = glm::vec4(0.5f + noise(generator));
    shown = add(frame, smoke, wall(12), i > 0);
  }
  double square = 0, most = 0;
  for (std::uint32_t y = 0; y < frame.size_px.y; ++y)
    for (std::uint32_t x = 0; x < frame.size_px.x; ++x) {
      const double off = std::abs(double{shown[x + kFrameSize.x * y].a} - 0.5);
      square += off * off;
      most = std::max(most, off);
    }
  EXPECT_LT(std::sqrt(square / (frame.size_px.x * frame.size_px.y)), 0.6 * 0.05);
  EXPECT_LT(most, 0.5) << "what lies beside the frame";
}

TEST_F(AccumulateTest, AHoleThatClosesLeavesNoGhost) {
  // A clear disc in opaque smoke, for a second; then it is shut. One step of a screen is 1/255.
  Texels open = even({0.2f, 0.2f, 0.2f, 0.0f});
  for (std::uint32_t i = 0; i < open.size(); ++i)
    if (glm::length(glm::vec2(i % kFrameSize.x, i / kFrameSize.x) - glm::vec2(16, 8)) < 5)
      open[i] = {0, 0, 0, 1};
  for (int i = 0; i < 24; ++i) (void)add(frame_at(0), open, wall(12), i > 0);
  for (const glm::vec4& shown : add(frame_at(0), even({0.2f, 0.2f, 0.2f, 0.0f}), wall(12), true)) {
    EXPECT_LT(shown.a, 1.0f / 255);
    EXPECT_NEAR(shown.r, 0.2f, 1.0f / 255);
  }
}

TEST_F(AccumulateTest, SurfacesThatComeIntoViewHaveNoPast) {
  // A pillar 2 m away in front of a wall moves a pixel a frame; in front of it is no smoke, beside it much.
  // Noise keeps the clipping from hiding what the depth must tell.
  std::mt19937 generator(3);
  std::normal_distribution<float> noise(0, 0.3f);
  for (std::uint32_t step = 0; step < 12; ++step) {
    std::vector<float> distances;
    Texels smoke;
    for (std::uint32_t i = 0; i < kFrameSize.x * kFrameSize.y; ++i) {
      const bool pillar = i % kFrameSize.x >= 6 + step && i % kFrameSize.x < 14 + step;
      distances.push_back(pillar ? 2.0f : 14.0f);
      smoke.push_back(glm::vec4(pillar ? 1.0f : std::max(0.0f, 0.3f + noise(generator))));
    }
    const Texels now = add(frame_at(0), smoke, distances, step > 0);
    if (step == 0) continue;
    for (std::uint32_t y = 0; y < kFrameSize.y; ++y) {
      // Left of the pillar the wall comes out from behind it.
      const std::uint32_t seen = 5 + step + kFrameSize.x * y;
      EXPECT_NEAR(now[seen].a, smoke[seen].a, 0.01f) << step;
      const std::uint32_t hidden = 13 + step + kFrameSize.x * y;
      EXPECT_NEAR(now[hidden].a, smoke[hidden].a, 0.01f) << step;
    }
  }
}

TEST_F(AccumulateTest, SmokeIsFoundWhereACameraThatMovedSawIt) {
  // Opaque smoke, whose light depends on the place where its bounds begin, at z = 10, seen from 10 m before
  // it while the camera goes by, 3 pixels a frame: each frame sees the same pattern moved, and noise. Found
  // again, the noise averages out as it does at rest; looked for on the wall behind, 2 pixels off, it would
  // not.
  const auto pattern = [](float x) { return 0.5f + 0.3f * std::sin(0.8f * x); };
  std::mt19937 generator(5);
  std::normal_distribution<float> noise(0, 0.05f);
  double square = 0;
  int count = 0;
  for (int i = 0; i < 24; ++i) {
    auto frame = frame_at(1.5f * static_cast<float>(i));
    frame.look.extinction = 20;
    frame.camera.eye_world.z = 20;
    frame.camera.clip_from_world[3].w = 20;
    const auto x_of = [&](std::uint32_t k) {
      const float ndc =
          (static_cast<float>(k % kFrameSize.x) + 0.5f) / static_cast<float>(kFrameSize.x) * 2 - 1;
      return frame.camera.eye_world.x + 10 * 0.8f * ndc;
    };
    Texels smoke;
    for (std::uint32_t k = 0; k < kFrameSize.x * kFrameSize.y; ++k)
      smoke.emplace_back(glm::vec3(pattern(x_of(k)) + noise(generator)), 0);
    const Texels shown = add(frame, smoke, wall(29), i > 0);
    for (std::uint32_t k = 0; i > 12 && k < shown.size(); ++k) {
      if (x_of(k) > frame.camera.eye_world.x) continue;  // it came into view lately
      square += std::pow(static_cast<double>(shown[k].r - pattern(x_of(k))), 2);
      ++count;
    }
  }
  EXPECT_LT(std::sqrt(square / count), 0.7 * 0.05);
}

}  // namespace
}  // namespace brume::passes
