#include "passes/antialias.hpp"

#include <cmath>
#include <functional>
#include <random>

#include "planning/device_camera.hpp"
#include "planning/media_plan.hpp"
#include "tests/gpu/gpu_test.hpp"
#include "tests/passes/film_frame.hpp"
#include "tests/passes/half.hpp"

namespace brume::passes {
namespace {

constexpr float kWall = 12;  // distance along the view axis [m]

class AntialiasTest : public gpu::GpuTest {
 protected:
  AntialiasTest() : pass_(context(), kFrameSize) {}

  using Texels = std::vector<glm::vec4>;
  using RadianceAt = std::function<glm::vec3(glm::vec2 position_px)>;
  static glm::vec2 jitter_of(int frame) {
    return frame == 0 ? glm::vec2(0) : planning::film_sample(static_cast<std::uint32_t>(frame)).pixel;
  }

  /// Adds frame `index` of a film before a wall; its result. The camera is at `x` [m].
  Texels add(int index, const RadianceAt& radiance_at, float x = 0, float transmittance = 1) {
    const glm::vec2 jitter = jitter_of(index);
    shared::FrameConstants frame = frame_at(x);
    const glm::mat4 middle = frame.camera.clip_from_world;
    frame.camera.shift = 2.0f * glm::vec2(jitter.x, -jitter.y) / glm::vec2(kFrameSize);
    frame.exposure = 1;
    frame.media = planning::smoke_media(frame.smoke, frame.look);
    std::vector<Half4> radiance, media;
    for (std::uint32_t y = 0; y < kFrameSize.y; ++y)
      for (std::uint32_t i = 0; i < kFrameSize.x; ++i)
        radiance.push_back(to_half(glm::vec4(radiance_at(glm::vec2(i, y) + 0.5f + jitter), 1)));
    media.assign(radiance.size(), to_half({0, 0, 0, transmittance}));
    const std::vector<float> reverse(radiance.size(), frame.camera.near_z / kWall);
    constexpr auto kHalf4 = VK_FORMAT_R16G16B16A16_SFLOAT;
    const auto radiance_image = upload_image(context(), runner(), kFrameSize, kHalf4, radiance);
    const auto media_image = upload_image(context(), runner(), kFrameSize, kHalf4, media);
    const auto depth = upload_image(context(), runner(), kFrameSize, VK_FORMAT_R32_SFLOAT, reverse);
    const auto buffer = upload(std::vector{frame});
    runner().run([&](gpu::Recorder& r) {
      pass_.record(r, {buffer, depth, media_image, radiance_image}, middle, jitter, index > 0);
    });
    Texels shown;
    shown = from_half(read_back<Half4>(pass_.result()));
    return shown;
  }

  AntialiasPass pass_;
};

/// Two roundings to half floats, and a value's way to its compressed form and back, of values below 1.
constexpr float kRounding = 0x1p-9f;

TEST_F(AntialiasTest, AFrameWithoutHistoryIsItself) {
  const auto noise = [](unsigned seed) {
    return [generator = std::mt19937(seed)](glm::vec2) mutable {
      return glm::vec3(from_half(to_half(glm::vec4(static_cast<float>(generator() % 1000)))));
    };
  };
  (void)add(0, noise(1));
  const Texels shown = add(0, noise(2));
  std::mt19937 again(2);
  for (const glm::vec4& texel : shown) ASSERT_EQ(texel.x, static_cast<float>(again() % 1000));
}

TEST_F(AntialiasTest, EdgesShowHowMuchOfEachPixelTheyCover) {
  // Brighter to the right of a slanted line. Of eight points of which no two share a row or a column of
  // eight, at most two are on the other side of a line than their pixel's area says.
  const auto beyond = [](glm::vec2 px) { return px.x - 16.3f - 0.37f * (px.y - 8.5f) > 0; };
  Texels shown;
  for (int i = 0; i < 64; ++i)
    shown = add(i, [&](glm::vec2 px) { return glm::vec3(beyond(px) ? 0.5f : 0.0f); });
  int partly = 0;
  for (std::uint32_t y = 1; y + 1 < kFrameSize.y; ++y)
    for (std::uint32_t x = 1; x + 1 < kFrameSize.x; ++x) {
      int covered = 0;
      for (int i = 0; i < 1024; ++i)
        covered += beyond(glm::vec2(x, y) + (glm::vec2(i % 32, i / 32) + 0.5f) / 32.0f);
      const float coverage = static_cast<float>(covered) / 1024;
      // Means are of r / (1 + r): a third where r is a half. The mean of the last frames ripples by half of 1
      // / 16.
      const float compressed = shown[x + kFrameSize.x * y].x / (1 + shown[x + kFrameSize.x * y].x) * 3;
      EXPECT_NEAR(compressed, coverage, 0.25f + 1.0f / 32 + kRounding) << x << " " << y;
      partly += compressed > 0.1f && compressed < 0.9f;
    }
  EXPECT_GE(partly, 15) << "a pixel a row, at least";
}

TEST_F(AntialiasTest, TheMiddleOfAPixelStaysWhereItIs) {
  // A gradient is the same after any number of frames, though each shows other points of it.
  const auto gradient = [](glm::vec2 px) { return glm::vec3(px / 64.0f, 0.2f); };
  Texels shown;
  for (int i = 0; i < 40; ++i) shown = add(i, gradient);
  for (std::uint32_t y = 1; y + 1 < kFrameSize.y; ++y)
    for (std::uint32_t x = 1; x + 1 < kFrameSize.x; ++x) {
      const glm::vec3 expected = gradient(glm::vec2(x, y) + 0.5f);
      // The means of a curved function differ by half its second derivative, at most 2, times the square of
      // how far the points spread, at most half a pixel; and the last frames count a sixteenth more or less.
      const float bound = (0.25f + 0.5f / 16) / 64 + kRounding;
      EXPECT_LT(glm::distance(glm::vec3(shown[x + kFrameSize.x * y]), expected), bound) << x << " " << y;
    }
}

TEST_F(AntialiasTest, WhatTheCameraPassesIsWhereItWas) {
  // A pixel of the wall is as wide as 1.6 m / 33 at a distance of 1 m. The camera moves by a third of one a
  // frame.
  const float pixel = 1.6f / 33 * kWall;
  Texels shown;
  float x = 0;
  const auto pattern = [&](glm::vec2 px) {
    const float world = x + (px.x - 16.5f) * pixel;
    return glm::vec3(0.3f + 0.1f * std::sin(world / pixel / 4));
  };
  for (int i = 0; i < 40; ++i) {
    x = static_cast<float>(i) * pixel / 3;
    shown = add(i, pattern, x);
  }
  // What has been in view for 16 frames.
  for (std::uint32_t i = 4; i + 16 / 3 + 2 < kFrameSize.x; ++i) {
    // A step from pixel to pixel is 0.1 / 4 at most. Half a pixel of jitter in one of sixteen frames moves
    // the mean by a thirty-second of that; a past that lags by the way of a frame, a third, moves it by
    // fifteen times as much, 5.
    const float expected = pattern({static_cast<float>(i) + 0.5f, 0}).x;
    EXPECT_NEAR(shown[i + kFrameSize.x * 8].x, expected, 0.1f / 4 / 6) << i;
  }
}

TEST_F(AntialiasTest, WhatIsGoneLeavesNoTrace) {
  for (int i = 0; i < 20; ++i) (void)add(i, [](glm::vec2) { return glm::vec3(0.5f, 0.2f, 0.1f); });
  for (const glm::vec4& texel : add(20, [](glm::vec2) { return glm::vec3(0.1f); }))
    EXPECT_NEAR(texel.x, 0.1f, kRounding);
}

TEST_F(AntialiasTest, SmokeIsFollowedAtItsOwnDistance) {
  // The camera passes opaque smoke whose pattern is where its box begins, 6 m nearer than the wall.
  Texels wall, near;
  const auto film = [&](float transmittance) {
    Texels shown;
    for (int i = 0; i < 12; ++i) {
      const float x = 0.4f * static_cast<float>(i);
      shown = add(
          i, [&](glm::vec2 px) { return glm::vec3(0.3f + 0.2f * std::sin(x + px.x * 0.3f)); }, x,
          transmittance);
    }
    return shown;
  };
  wall = film(1);
  near = film(0);
  EXPECT_NE(wall, near);
}

TEST_F(AntialiasTest, AnInvalidatedPastIsNotContinued) {
  (void)add(0, [](glm::vec2 px) { return glm::vec3(px.x > 16 ? 0.5f : 0.0f); });
  runner().run([&](gpu::Recorder& recorder) { pass_.invalidate_past(recorder); });
  for (const glm::vec4& texel : add(1, [](glm::vec2) { return glm::vec3(0.25f); })) EXPECT_EQ(texel.x, 0.25f);
}

}  // namespace
}  // namespace brume::passes
