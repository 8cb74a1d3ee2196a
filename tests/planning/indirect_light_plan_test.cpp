#include "planning/indirect_light_plan.hpp"

#include <gtest/gtest.h>

namespace brume::planning {
namespace {

class IndirectLightCacheTest : public testing::Test {
 protected:
  IndirectLightCacheTest() {
    input_.level.voxels.grid = &grid_;
    input_.environment.bounces = 3;
    lights_.resize(1);
  }
  IndirectLightPlan plan() {
    IndirectLightPlan plan = cache_.plan(input_, media_, holes_, lights_);
    if (commits_) cache_.commit();
    return plan;
  }
  bool commits_ = true;
  static constexpr std::uint32_t kAll = 3 * kSlicesPerBounce;

  voxel::BitGrid grid_{{glm::ivec3(8), 0.5f, glm::vec3(0)}}, other_grid_{{glm::ivec3(8), 0.5f, glm::vec3(0)}};
  FrameInput input_;
  MediaPlan media_;
  HolePlan holes_;
  std::vector<shared::Light> lights_;
  IndirectLightCache cache_;
};

TEST_F(IndirectLightCacheTest, AFrameThatIsNotCommittedIsPlannedAgain) {
  for (const bool commits : {false, true}) {
    commits_ = commits;
    const IndirectLightPlan first = plan();
    EXPECT_EQ(first.slices.count, kAll);
    EXPECT_TRUE(first.level_changed);
    EXPECT_EQ(first.version, 1u);
  }
  // Over several frames: the slices follow those that were drawn.
  input_.quality.light_update_fraction = 0.25f;
  lights_[0].intensity = glm::vec3(7);
  EXPECT_EQ(plan().slices.first, 0u);
  commits_ = false;
  const volume::IndexRange second = plan().slices;
  EXPECT_GT(second.first, 0u);
  EXPECT_EQ(plan().slices.first, second.first);
}

TEST_F(IndirectLightCacheTest, FindsLightOnceAndAgainWhereItChanged) {
  const IndirectLightPlan first = plan();
  EXPECT_TRUE(first.level_changed);
  EXPECT_EQ(first.slices, (volume::IndexRange{0, kAll}));
  const IndirectLightPlan second = plan();
  EXPECT_FALSE(second.level_changed);
  EXPECT_EQ(second.slices.count, 0u);
  EXPECT_EQ(second.version, first.version);
  lights_[0].intensity = glm::vec3(2);
  const IndirectLightPlan third = plan();
  EXPECT_FALSE(third.level_changed);
  EXPECT_EQ(third.slices, (volume::IndexRange{0, kAll}));
  EXPECT_NE(third.version, first.version);
  input_.quality.rebuild_light = true;
  EXPECT_EQ(plan().slices.count, kAll);
}

TEST_F(IndirectLightCacheTest, WithoutBouncesOrLevelThereIsNone) {
  input_.environment.bounces = 0;
  EXPECT_EQ(plan().bounces, 0u);
  input_.environment.bounces = 2;
  EXPECT_EQ(plan().slices.count, 2 * kSlicesPerBounce);
  input_.level.voxels.grid = nullptr;
  EXPECT_EQ(plan().bounces, 0u);
}

TEST_F(IndirectLightCacheTest, SlicesCoverAllOnceAndThenShow) {
  const std::uint64_t version = plan().version;
  input_.quality.light_update_fraction = 0.15f;
  lights_[0].intensity = glm::vec3(2);
  std::uint32_t next = 0;
  while (next < kAll) {
    const IndirectLightPlan part = plan();
    EXPECT_EQ(part.slices.first, next);
    EXPECT_GT(part.slices.count, 0u);
    EXPECT_LE(part.slices.count, 4u);  // 0.15 of 24, rounded up
    next += part.slices.count;
    EXPECT_EQ(part.version == version, next < kAll) << "it shows when it is complete";
    // What changes meanwhile is found afterwards.
    lights_[0].intensity = glm::vec3(3);
  }
  EXPECT_EQ(next, kAll);
  EXPECT_EQ(plan().slices.first, 0u);
}

TEST_F(IndirectLightCacheTest, AChangedLevelIsLitAtOnce) {
  plan();
  input_.quality.light_update_fraction = 0.1f;
  input_.level.voxels.grid = &other_grid_;
  const IndirectLightPlan moved = plan();
  EXPECT_TRUE(moved.level_changed);
  EXPECT_EQ(moved.slices, (volume::IndexRange{0, kAll}));
  input_.level.hidden_objects = {2};
  EXPECT_TRUE(plan().level_changed);
}

}  // namespace
}  // namespace brume::planning
