#include "planning/exposure.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

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

// A black car before a grey ground: the ground is not burnt.
TEST(Exposure, HoldsTheBrightQuarter) {
  for (const float black : {0.0f, 1e-9f, 1e-3f})
    EXPECT_NEAR(exposure_of(picture(black, 0.5f, 0.3)), 1.3f, 1e-4f);
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
