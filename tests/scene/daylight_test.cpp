#include "scene/daylight.hpp"

#include <gtest/gtest.h>

#include <numbers>

namespace brume::scene {
namespace {

float radians(float degrees) {
  return degrees * std::numbers::pi_v<float> / 180;
}

TEST(Daylight, IsThatOfNoonFromTwentyEightDegreesOn) {
  for (const float degrees : {28.1f, 49.0f, 90.0f})
    EXPECT_EQ(sunlight_fraction(radians(degrees)), glm::vec3(1)) << degrees;
  SkyOptions sky;
  const SkyOptions noon = sky;
  EXPECT_EQ(dim_sky(sky, radians(60)), 1);
  EXPECT_EQ(sky.zenith, noon.zenith);
  EXPECT_EQ(sky.horizon, noon.horizon);
  EXPECT_EQ(sky.ambient, noon.ambient);
}

// Light that goes through twice as much more air is the square.
TEST(Daylight, FallsExponentiallyWithTheWayThroughTheAir) {
  // Air masses of Kasten and Young's table at these elevations.
  const double noon = 2.1246, low = 5.5846, lower = 9.0445;  // 28, 10 and about 5.8 degrees
  const glm::vec3 once = sunlight_fraction(radians(10));
  const glm::vec3 twice = sunlight_fraction(radians(5.917f));
  ASSERT_NEAR(lower - noon, 2 * (low - noon), 1e-3);
  for (int color = 0; color < 3; ++color)
    EXPECT_NEAR(twice[color], once[color] * once[color], 0.01f) << color;
}

TEST(Daylight, GetsDimmerAndRedderTowardsTheHorizon) {
  glm::vec3 above(1);
  for (const float degrees : {27.0f, 20.0f, 12.0f, 6.0f, 2.0f, 0.0f}) {
    const glm::vec3 sun = sunlight_fraction(radians(degrees));
    for (int color = 0; color < 3; ++color) EXPECT_LT(sun[color], above[color]) << degrees;
    EXPECT_GT(sun.r / sun.g, above.r / above.g) << degrees;
    EXPECT_GT(sun.g / sun.b, above.g / above.b) << degrees;
    above = sun;
  }
  EXPECT_EQ(sunlight_fraction(-1), sunlight_fraction(0));
  SkyOptions sky;
  EXPECT_LT(dim_sky(sky, 0), 0.5f);
  EXPECT_GT(sky.horizon.r, sky.horizon.b);
  EXPECT_GT(sky.zenith.b, sky.zenith.r);
}

}  // namespace
}  // namespace brume::scene
