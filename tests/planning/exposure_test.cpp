#include "planning/exposure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "shared/tone.h"

namespace brume::planning {
namespace {

/// Pixels of two brightnesses, a fraction of them `bright`.
std::vector<glm::vec4> picture(float dark, float bright, double fraction) {
  std::vector<glm::vec4> pixels(1000, glm::vec4(glm::vec3(dark), 1));
  for (std::size_t i = 0; i < static_cast<std::size_t>(1000 * fraction); ++i)
    pixels[i] = glm::vec4(glm::vec3(bright), 1);
  return pixels;
}

TEST(Exposure, HalvesWhereTheLightDoubles) {
  for (const float light : {1e-6f, 1e-3f, 1.0f, 1e3f, 1e6f}) {
    const float exposure = exposure_of(picture(0.1f * light, 0.5f * light, 0.4));
    EXPECT_NEAR(exposure * light, exposure_of(picture(0.1f, 0.5f, 0.4)), 1e-5f * exposure * light) << light;
  }
}

TEST(Exposure, BringsAnEvenPictureToTheMiddle) {
  EXPECT_NEAR(exposure_of(picture(2, 2, 1)), 0.14f, 1e-6f);
}

// Windows of a dark room.
TEST(Exposure, HoldsTheBrightQuarter) {
  for (const float black : {0.0f, 1e-9f, 1e-3f})
    EXPECT_NEAR(exposure_of(picture(black, 0.5f, 0.3)), 1.3f, 1e-4f);
}

// A black, grey or white car before a grey ground, which is at most 60 % of white.
TEST(Exposure, LeavesTheGroundGreyBehindAnySubject) {
  constexpr float kGround = 0.33f;
  for (const float car : {0.0f, 1e-3f, 0.05f, 0.2f, 0.9f})
    for (const double share : {0.05, 0.3, 0.6}) {
      const float exposure = car < kGround ? exposure_of(picture(car, kGround, 1 - share))
                                           : exposure_of(picture(kGround, car, share));
      const glm::vec3 shown =
          shared::srgb_from_linear(shared::tone_curve(shared::kToneNeutral, glm::vec3(exposure * kGround)));
      EXPECT_LE(shown.x, 0.6f) << car << ' ' << share;
      EXPECT_GE(shown.x, 0.25f) << car << ' ' << share;
    }
}

// A light that covers little burns: the rest is what is looked at.
TEST(Exposure, LeavesSmallLightsBurnt) {
  EXPECT_NEAR(exposure_of(picture(0.28f, 1e3f, 0.001)), 1, 0.01f);
}

TEST(Exposure, OfBlackIsFinite) {
  const float exposure = exposure_of(picture(0, 0, 1));
  EXPECT_TRUE(std::isfinite(exposure));
  EXPECT_GT(exposure, 0);
}

}  // namespace
}  // namespace brume::planning
