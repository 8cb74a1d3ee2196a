#include "planning/hole_plan.hpp"

#include <gtest/gtest.h>

#include "tests/planning/random_holes.hpp"
#include "tests/sanitized.hpp"

namespace brume::planning {
namespace {

/// Smoke of quarter-metre voxels that reaches a hundred metres each way.
shared::VolumeLayout wide_volume() {
  shared::VolumeLayout volume{};
  volume.voxel_size = 0.25f;
  volume.bounds_min = glm::vec3(-400);
  volume.bounds_max = glm::vec3(400);
  return volume;
}

TEST(HolePlan, OmitsWhatIsNotOpen) {
  std::vector<shared::Hole> holes = random_holes(3, 1, 5);
  for (shared::Hole& hole : holes) {
    hole.time_to_reach_far = 0.25f;
    hole.time_to_expand = 0.05f;
    hole.time_to_stay_open = 1;
    hole.time_to_fade = 0.35f;
  }
  holes[0].time_start = 2;    // still to come
  holes[1].time_start = -10;  // long closed
  holes[2].time_start = 0.125f;
  const HolePlan plan = plan_holes(holes, 1, 0, wide_volume(), 10, {1, 1});
  ASSERT_EQ(plan.holes.size(), 1u);
  EXPECT_EQ(plan.holes[0].time_start, 0.125f);
}

TEST(HolePlan, HasRoomForEveryBrickThatAHoleReaches) {
  // Bricks of 2 m: at most those whose middle is within the radius and half their diagonal of the axis.
  auto holes = random_holes(kSanitized ? 40 : 100, 2, 20);
  for (shared::Hole& hole : holes) {
    hole.time_start = 0;
    hole.time_to_stay_open = 100;
  }
  std::size_t met = 0;
  for (const shared::Hole& hole : holes) {
    const float reach = hole.radius * 1.4143f + 1.7321f;
    for (int x = -40; x < 40; ++x)
      for (int y = -40; y < 40; ++y)
        for (int z = -40; z < 40; ++z) {
          const glm::vec3 apart = 2.0f * glm::vec3(x, y, z) + 1.0f - hole.origin_world;
          const float along = glm::clamp(glm::dot(apart, hole.forward), 0.0f, hole.distance_to_far);
          met += glm::length(apart - along * hole.forward) <= reach ? 1 : 0;
        }
  }
  EXPECT_GE(plan_holes(holes, 50, 0, wide_volume(), 512000, {1, 1}).pair_capacity, met);
  EXPECT_GT(met, 1000u);
}

TEST(HolePlan, DrawsTheLastOfTooMany) {
  std::vector<shared::Hole> holes(shared::kMaxHoles + 5, random_holes(1, 1, 5)[0]);
  for (std::size_t i = 0; i < holes.size(); ++i) {
    holes[i].time_start = 0;
    holes[i].time_to_stay_open = 1 + static_cast<float>(i);
  }
  const HolePlan plan = plan_holes(holes, 0.5f, 0, wide_volume(), 10, {1, 1});
  ASSERT_EQ(plan.holes.size(), shared::kMaxHoles);
  EXPECT_EQ(plan.holes.front().time_to_stay_open, 6);
}

}  // namespace
}  // namespace brume::planning
