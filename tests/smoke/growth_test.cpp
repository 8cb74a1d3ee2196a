#include "smoke/growth.hpp"

#include <gtest/gtest.h>

#include "sim/world.hpp"

namespace brume::smoke {
namespace {

constexpr int kEdge = 24;

voxel::BitGrid empty_grid() {
  return voxel::BitGrid(voxel::GridLayout{glm::ivec3(kEdge), 0.5f, glm::vec3(0)});
}

sim::Cloud cloud_in(const voxel::BitGrid& grid, glm::ivec3 source, std::uint32_t voxels) {
  sim::CloudOrigin origin;
  origin.source = source;
  origin.settings.voxels = voxels;
  return sim::Cloud(grid, origin);
}

TEST(Growth, IsStraightFromTheSourceInTheOpen) {
  const glm::ivec3 source(12, 12, 12);
  const sim::Cloud cloud = cloud_in(empty_grid(), source, 3000);
  const auto growth = growth_of(cloud);
  ASSERT_EQ(growth.size(), 3000u);
  cloud.voxels().for_each([&](glm::ivec3 voxel, std::uint32_t rank) {
    EXPECT_LT(glm::length(growth[rank] - glm::vec3(voxel - source)), 1e-4f);
  });
}

/// A wall across x = 12 with a door of 2 x 2 voxels at z = 4, 5.
voxel::BitGrid with_door() {
  voxel::BitGrid grid = empty_grid();
  for (int z = 0; z < kEdge; ++z)
    for (int y = 0; y < kEdge; ++y)
      if (y > 1 || z < 4 || z > 5) grid.set({12, y, z}, true);
  return grid;
}

TEST(Growth, TurnsAtADoor) {
  const sim::Cloud cloud = cloud_in(with_door(), {8, 0, 16}, 9000);
  const auto growth = growth_of(cloud);
  int beyond = 0;
  cloud.voxels().for_each([&](glm::ivec3 voxel, std::uint32_t rank) {
    const float length = glm::length(growth[rank]);
    // As long as a way around the wall: no shorter than the straight line, no longer than the chamfer's,
    // whose corner step is 17 for 17.32.
    EXPECT_GE(length, glm::length(glm::vec3(voxel - glm::ivec3(8, 0, 16))) - 1e-3f);
    EXPECT_LE(length, 1.019f / 10 * static_cast<float>(cloud.distances()[rank]) + 1e-3f);
    if (voxel.x <= 14) return;
    // Behind the wall smoke comes from the door, not through the wall from the source.
    ++beyond;
    float best = -1;
    for (int i = 0; i < 12; ++i) {
      const glm::ivec3 in_door(11 + i % 3, i / 3 % 2, 4 + i / 6);
      best =
          std::max(best, glm::dot(glm::normalize(growth[rank]), glm::normalize(glm::vec3(voxel - in_door))));
    }
    EXPECT_GT(best, 0.9f);
  });
  EXPECT_GT(beyond, 400);
}

TEST(Growth, NeighboursInTheOpenAreNeverFarApart) {
  const sim::Cloud cloud = cloud_in(with_door(), {8, 0, 16}, 9000);
  const auto growth = growth_of(cloud);
  // Around a door it bends by no more than a way's length times the angle between two neighbours: nowhere
  // does its length jump.
  cloud.voxels().for_each([&](glm::ivec3 voxel, std::uint32_t rank) {
    for (const glm::ivec3 step : {glm::ivec3(1, 0, 0), glm::ivec3(0, 1, 0), glm::ivec3(0, 0, 1)}) {
      const std::uint32_t other = cloud.voxels().rank(voxel + step);
      if (other == sim::BlockSet::kNone) continue;
      EXPECT_LT(std::abs(glm::length(growth[rank]) - glm::length(growth[other])), 1.5f);
    }
  });
}

TEST(Growth, OfNothingIsNothing) {
  voxel::BitGrid grid = empty_grid();
  grid.set({3, 3, 3}, true);
  EXPECT_TRUE(growth_of(cloud_in(grid, {3, 3, 3}, 10)).empty());
  const auto one = growth_of(cloud_in(empty_grid(), {3, 3, 3}, 1));
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0], glm::vec3(0));
}

}  // namespace
}  // namespace brume::smoke
