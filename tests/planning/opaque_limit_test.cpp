#include "planning/opaque_limit.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "planning/blackbody.hpp"
#include "planning/device_camera.hpp"
#include "shared/opaque.h"
#include "tests/worlds.hpp"

namespace brume::planning {
namespace {

TEST(OpaqueLimitTest, IsTheUsualOneUpToTwiceTheDisplay) {
  for (const float displayed : {0.0f, 0.3f, 1.0f, 2.0f})
    EXPECT_EQ(shared::opaque_below(0.004f, displayed), 0.004f);
  for (const float displayed : {2.5f, 20.0f, 1e6f}) {
    const float limit = shared::opaque_below(0.004f, displayed);
    EXPECT_LE(limit * displayed, 1.001f / 1024);
    EXPECT_LT(limit, 0.004f);
  }
  EXPECT_EQ(shared::opaque_below(1e-4f, 3), 1e-4f) << "never more than the usual one";
}

TEST(OpaqueLimitTest, StepsGrowAsUsualUnlessSourcesAreOutshone) {
  for (const float displayed : {0.0f, 1.0f, 255.0f}) {
    const float opaque = shared::opaque_below(0.004f, displayed);
    EXPECT_EQ(shared::coarse_below(opaque), 0.25f) << displayed;
  }
  EXPECT_FLOAT_EQ(shared::coarse_below(shared::opaque_below(0.004f, 2560)), 0.025f);
  EXPECT_EQ(shared::coarse_below(0), 0.25f) << "rays that never end";
}

TEST(OpaqueLimitTest, TheBrightestCounts) {
  FrameInput input;
  MediaPlan media;
  const ViewFrustum frustum(device_camera(input.view.camera, glm::uvec2(16, 9)));
  EXPECT_EQ(brightest_behind(input, frustum, {}, media, {}), 0);
  input.environment.sky.horizon = {0.2f, 0.3f, 0.1f};
  input.environment.sky.zenith = {0, 0, 0.25f};
  EXPECT_EQ(brightest_behind(input, frustum, {}, media, {}), 0.3f);

  shared::Light sun = sun_light({0, -1, 0}, 1);
  sun.intensity = glm::vec3(1, 10, 2);
  const shared::Light point = point_light({}, glm::vec3(1e6f));
  EXPECT_NEAR(brightest_behind(input, frustum, {}, media, std::vector{point, sun}), 5 / std::numbers::pi,
              1e-5);

  // A fire, whose hottest part counts.
  const volume::SparseVolume heat({{}, 1, {{sizeof(std::uint16_t)}}});
  input.volumes.resize(1);
  input.volumes[0].heat = {.volume = &heat, .kelvin = 2000, .high = 1.5f, .emission = 2};
  media.volumes.push_back({0, {glm::vec3(0), glm::vec3(3, 2, 4)}});
  EXPECT_NEAR(brightest_behind(input, frustum, {}, media, {}), 0.3f, 1e-6f) << "not in view";
  media.frame.volume_count = 1;
  EXPECT_FLOAT_EQ(brightest_behind(input, frustum, {}, media, {}), 2 * blackbody_color(3000).r);
  // A mask, along the shortest side.
  input.volumes[0].tints = {{1, 40, 3}};
  EXPECT_FLOAT_EQ(brightest_behind(input, frustum, {}, media, {}), 80);
  media.volumes[0].instance.look.emission = {100, 0, 0};
  EXPECT_FLOAT_EQ(brightest_behind(input, frustum, {}, media, {}), 100);
}

}  // namespace
}  // namespace brume::planning
