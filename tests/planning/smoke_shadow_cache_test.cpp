#include "planning/smoke_shadow_cache.hpp"

#include <gtest/gtest.h>

#include <array>
#include <set>
#include <span>

#include "tests/worlds.hpp"

namespace brume::planning {
namespace {

/// A smoke, a light above it and a camera before it.
class SmokeShadowCacheTest : public ::testing::Test {
 protected:
  SmokeShadowCacheTest() {
    camera_.eye_world = {8, 1, 40};
    camera_.forward = {0, 0, -1};
    camera_.right = {1, 0, 0};
    camera_.up = {0, 1, 0};
    inputs_.look.extinction = 3;
    inputs_.time = 10;
    inputs_.update_fraction = 1;
  }
  /// The update of a frame with what is set below.
  std::optional<SmokeShadowUpdate> update() {
    inputs_.volume = &volume_;
    return update(smoke_boxes(volume_, visibility_));
  }
  std::optional<SmokeShadowUpdate> update(std::span<const Box<float>> casters) {
    inputs_.visibility = &visibility_;
    inputs_.lights = lights_;
    inputs_.holes = &holes_;
    inputs_.noise = &noise_;
    auto update =
        cache_.update(plan_smoke_shadows({lights_, glm::mat4(1), camera_}, casters, {1024, 256}), inputs_);
    if (commits_) cache_.commit();
    return update;
  }
  /// Expects that something changed, and that it is up to date then.
  void expect_one_update(const char* what) {
    EXPECT_TRUE(update()) << what;
    EXPECT_FALSE(update()) << what << ", again";
  }
  void place_hole() {
    const shared::Hole hole = open_hole({8, 1, 4}, {0, 0, 1}, 0.2f, 8, 1);
    holes_ = plan_holes({&hole, 1}, inputs_.time, 0, volume_.layout(), volume_.slot_count(), {16, 16});
    ASSERT_EQ(holes_.holes.size(), 1u);
  }

  Yard yard_{{8}};
  const smoke::SmokeVolume& volume_ = yard_.volume;
  SmokeVisibility visibility_ = all_smoke_visible(volume_);
  std::vector<shared::Light> lights_{point_light({8, 6, 8}, glm::vec3(2), 0)};
  shared::Camera camera_{};
  HolePlan holes_;
  NoisePlan noise_;
  SmokeShadowInputs inputs_;
  SmokeShadowCache cache_;
  bool commits_ = true;
};

TEST_F(SmokeShadowCacheTest, ACameraThatFliesMarchesNothing) {
  const auto first = update();
  ASSERT_TRUE(first);
  EXPECT_EQ(first->spread, 1u);
  EXPECT_GT(first->plan.blocks, 0u);
  for (int i = 0; i < 10; ++i) {
    camera_.eye_world.x += 0.1f;
    camera_.eye_world.z -= 0.5f;
    EXPECT_FALSE(update()) << "the eye is not read";
  }
  // Nor is the clock, where neither noise nor holes move with it.
  inputs_.time += 1;
  inputs_.look.albedo = glm::vec3(0.5f);
  inputs_.look.step_length *= 2;
  EXPECT_FALSE(update());
  cache_.invalidate();
  EXPECT_TRUE(update());
}

TEST_F(SmokeShadowCacheTest, AFrameThatIsNotCommittedIsPlannedAgain) {
  for (const bool commits : {false, false, true}) {
    commits_ = commits;
    EXPECT_TRUE(update());
  }
  EXPECT_FALSE(update());
  // A quarter of the texels: the same one until it is drawn.
  inputs_.update_fraction = 0.25f;
  inputs_.rebuild = true;
  const glm::uvec2 first = update()->first;
  inputs_.rebuild = false;
  commits_ = false;
  const glm::uvec2 second = update()->first;
  EXPECT_NE(second, first);
  EXPECT_EQ(update()->first, second);
}

TEST_F(SmokeShadowCacheTest, WhatIsReadIsMarchedAgain) {
  update();
  lights_[0].position_world.x += 0.001f;
  expect_one_update("a light");
  inputs_.look.extinction += 1;
  expect_one_update("the look");
  inputs_.rebuild = true;
  EXPECT_TRUE(update()) << "an edit of the level";
  inputs_.rebuild = false;
  EXPECT_FALSE(update());
  visibility_.slots.pop_back();
  --visibility_.visible_count;
  expect_one_update("the smoke that casts shadows");
  yard_.append(lasting_smoke_at({20, 1, 8}, 400, 300));
  yard_.advance_to(600);
  visibility_ = all_smoke_visible(volume_);
  expect_one_update("smoke");
}

// The shadows of volumes in a frame without smoke.
TEST_F(SmokeShadowCacheTest, VolumesAloneAreMarchedAgainWhenTheyChange) {
  const auto update_alone = [&] {
    return update(std::array{Box<float>{glm::vec3(6, 0, 6), glm::vec3(10, 4, 10)}});
  };
  EXPECT_TRUE(update_alone());
  EXPECT_FALSE(update_alone());
  inputs_.rebuild = true;
  EXPECT_TRUE(update_alone());
  inputs_.rebuild = false;
  EXPECT_FALSE(update_alone());
}

TEST_F(SmokeShadowCacheTest, SlotsThatCastShadowsInViewOrOutOfItAreTheSame) {
  ASSERT_GT(visibility_.slots.size(), 3u);
  update();
  // The first one goes out of view, and still casts a shadow.
  visibility_.slots.push_back(visibility_.slots.front());
  visibility_.slots.erase(visibility_.slots.begin());
  --visibility_.visible_count;
  EXPECT_FALSE(update());
}

TEST_F(SmokeShadowCacheTest, HolesMoveWithTheClock) {
  update();
  place_hole();
  expect_one_update("a hole");
  inputs_.time += 0.1f;
  place_hole();
  expect_one_update("its later shape");
  holes_ = {};
  expect_one_update("none");
  inputs_.time += 0.1f;
  EXPECT_FALSE(update());
}

TEST_F(SmokeShadowCacheTest, NoiseMovesWithTheClockAndWithImpulses) {
  noise_.motion.impulses.resize(1);
  update();
  noise_.motion.impulses[0].radius = 1;
  EXPECT_FALSE(update()) << "no noise, nothing to move";
  inputs_.look.erosion = 0.5f;
  expect_one_update("erosion");
  inputs_.time += 0.1f;
  expect_one_update("time");
  noise_.motion.impulses[0].radius = 2;
  expect_one_update("an impulse");
  inputs_.look.swirl += 0.1f;
  expect_one_update("the swirl");
  inputs_.look.detail += 0.5f;
  expect_one_update("the detail");
  // Bricks whose noise is late.
  noise_.catches_up = true;
  EXPECT_TRUE(update());
  noise_.catches_up = false;
  EXPECT_FALSE(update());
}

TEST_F(SmokeShadowCacheTest, SlicesAreDoneInFourFrames) {
  update();
  inputs_.update_fraction = 0.25f;
  EXPECT_FALSE(update());
  for (int repeat = 0; repeat < 3; ++repeat) {
    inputs_.look.extinction += 1;
    std::set<std::pair<std::uint32_t, std::uint32_t>> texels;
    for (int frame = 0; frame < 4; ++frame) {
      const auto slice = update();
      ASSERT_TRUE(slice);
      EXPECT_EQ(slice->spread, 2u);
      texels.insert({slice->first.x, slice->first.y});
    }
    EXPECT_EQ(texels.size(), 4u);
    EXPECT_FALSE(update());
  }
  // Another plan moves the texels: all at once.
  visibility_.caster_bounds.high.x -= 4;
  const auto moved = update();
  ASSERT_TRUE(moved);
  EXPECT_EQ(moved->spread, 1u);
  EXPECT_FALSE(update());
  // And what was begun in slices is completed at once.
  inputs_.look.extinction += 1;
  update();
  inputs_.update_fraction = 1;
  const auto rest = update();
  ASSERT_TRUE(rest);
  EXPECT_EQ(rest->spread, 1u);
  EXPECT_FALSE(update());
}

}  // namespace
}  // namespace brume::planning
