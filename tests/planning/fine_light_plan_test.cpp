#include "planning/fine_light_plan.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/worlds.hpp"

namespace brume::planning {
namespace {

constexpr float kVoxelSize = 0.5f;

/// A row of smokes along x, in a world without walls.
class FineLightPlanTest : public ::testing::Test {
 protected:
  static const smoke::SmokeVolume& row() {
    static SmokeWorld made(voxel::BitGrid({{820, 40, 40}, kVoxelSize, glm::vec3(0)}));
    if (made.world.tick() > 0) return made.volume;
    for (int i = 0; i < 40; ++i) made.append(smoke_at({5 + 10 * i, 8, 10}, 1500));
    made.advance_to(90);
    return made.volume;
  }
  /// From a point to the nearest of a slot's brick [m].
  float distance(std::uint32_t slot, const glm::vec3& eye) const {
    const glm::vec3 low = volume_.layout().origin_world + 8 * kVoxelSize * glm::vec3(volume_.brick_of(slot));
    return glm::distance(eye, glm::clamp(eye, low, low + 8 * kVoxelSize));
  }

  const smoke::SmokeVolume& volume_ = row();
  const SmokeVisibility visibility_ = all_smoke_visible(volume_);
};

TEST_F(FineLightPlanTest, TakesTheNearestBricksFirst) {
  for (const glm::vec3 eye : {glm::vec3(0, 8, 10), glm::vec3(200, 15, 2), glm::vec3(500, 8, 10)}) {
    const FineLightPlan plan = plan_fine_light(volume_, visibility_, eye, {1e-4f});
    ASSERT_GT(visibility_.visible_count, kMostFinePages);
    ASSERT_EQ(plan.slots.size(), kMostFinePages);
    ASSERT_EQ(plan.pages.size(), volume_.slot_count());
    float farthest = 0;
    for (const std::uint32_t slot : plan.slots) {
      EXPECT_GE(distance(slot, eye), farthest);
      farthest = distance(slot, eye);
    }
    for (std::uint32_t i = 0; i < visibility_.visible_count; ++i) {
      const std::uint32_t slot = visibility_.slots[i], page = plan.pages[slot];
      if (page > 0) {
        EXPECT_EQ(plan.slots[page - 1], slot);
      } else {
        EXPECT_GE(distance(slot, eye), farthest);
      }
    }
    EXPECT_EQ(std::count(plan.pages.begin(), plan.pages.end(), 0u),
              std::ptrdiff_t{volume_.slot_count()} - std::ptrdiff_t{kMostFinePages});
  }
}

TEST_F(FineLightPlanTest, LeavesOutWhatTwoPixelsAreWiderThan) {
  const glm::vec3 eye(0, 8, 10);
  // A texel of an eighth of a metre is as wide as two pixels at 30 m.
  const FineLightPlan plan = plan_fine_light(volume_, visibility_, eye, {0.125f / 60});
  EXPECT_FALSE(plan.slots.empty());
  for (std::uint32_t i = 0; i < visibility_.visible_count; ++i) {
    const std::uint32_t slot = visibility_.slots[i];
    EXPECT_EQ(plan.pages[slot] > 0, distance(slot, eye) < 30) << distance(slot, eye);
  }
}

TEST_F(FineLightPlanTest, KeepsTheNearestPages) {
  FineLightPlan plan = plan_fine_light(volume_, visibility_, glm::vec3(0, 8, 10), {1e-4f});
  const FineLightPlan all = plan;
  for (const std::uint32_t count : {kMostFinePages + 1, kMostFinePages, 7u, 0u}) {
    keep_pages(plan, count);
    ASSERT_EQ(plan.slots.size(), std::min(count, kMostFinePages));
    EXPECT_TRUE(std::equal(plan.slots.begin(), plan.slots.end(), all.slots.begin()));
    for (std::uint32_t slot = 0; slot < volume_.slot_count(); ++slot)
      EXPECT_EQ(plan.pages[slot], all.pages[slot] <= count ? all.pages[slot] : 0u);
  }
}

TEST_F(FineLightPlanTest, HasNothingWithoutVisibleSmoke) {
  const FineLightPlan plan = plan_fine_light(volume_, {}, glm::vec3(0), {1e-3f});
  EXPECT_TRUE(plan.slots.empty());
  EXPECT_EQ(plan.pages.size(), volume_.slot_count());
  EXPECT_EQ(std::count(plan.pages.begin(), plan.pages.end(), 0u), std::ptrdiff_t{volume_.slot_count()});
}

}  // namespace
}  // namespace brume::planning
