#include "scenario/flashes.hpp"

#include <gtest/gtest.h>

#include "scene/event_fields.hpp"

namespace brume::scenario {
namespace {

scene::Timeline timeline() {
  scene::Timeline timeline;
  timeline.shots.resize(2);
  timeline.shots[0].time = 1;
  timeline.shots[0].from_world = {1, 2, 3};
  timeline.shots[0].toward_world = {1, 2, -7};
  timeline.shots[0].flash = 40;
  timeline.shots[1].time = 1;
  timeline.shots[1].flash = 0;
  timeline.blasts.resize(1);
  timeline.blasts[0].time = 1.03;  // in tick 65
  timeline.blasts[0].at_world = {0, 1, 0};
  timeline.blasts[0].flash = 100;
  return timeline;
}

TEST(Flashes, StartAtTheTickOfTheirEventAndFade) {
  const scene::Timeline events = timeline();
  EXPECT_TRUE(flashes_of(events, 0.99).empty());
  const auto first = flashes_of(events, 1);
  ASSERT_EQ(first.size(), 1u) << "a flash of 0 is none";
  EXPECT_EQ(first[0].position_world, glm::vec3(1, 2, 3 - scene::kMuzzleAhead));
  EXPECT_EQ(first[0].intensity.r, 40);
  EXPECT_GT(first[0].intensity.r, first[0].intensity.b);
  EXPECT_EQ(first[0].range, shared::light_range(40));
  EXPECT_EQ(first[0].kind, shared::kLightPoint);
  EXPECT_EQ(first[0].shadow_layer, shared::kShadowByVoxels);

  const double tick_65 = 65.0 / 64, muzzle_seconds = scene::flash_of(events.shots[0]).seconds;
  EXPECT_EQ(flashes_of(events, tick_65 - 1e-3).size(), 1u);
  EXPECT_EQ(flashes_of(events, tick_65).size(), 2u);
  EXPECT_NEAR(flashes_of(events, 1 + muzzle_seconds / 2)[0].intensity.r, 10, 1e-4);
  EXPECT_EQ(flashes_of(events, 1 + muzzle_seconds).size(), 1u) << "the explosion alone";
  EXPECT_TRUE(flashes_of(events, tick_65 + scene::flash_of(events.blasts[0]).seconds).empty());
}

TEST(Flashes, AnExplosionTurnsRedAboveItsPosition) {
  const scene::Timeline events = timeline();
  const auto early = flashes_of(events, 1.1), late = flashes_of(events, 1.25);
  ASSERT_EQ(early.size(), 1u);
  ASSERT_EQ(late.size(), 1u);
  EXPECT_EQ(early[0].position_world, glm::vec3(0, 1 + scene::kFireballAbove, 0));
  EXPECT_LT(late[0].intensity.r, early[0].intensity.r);
  EXPECT_LT(late[0].intensity.g / late[0].intensity.r, early[0].intensity.g / early[0].intensity.r);
}

}  // namespace
}  // namespace brume::scenario
