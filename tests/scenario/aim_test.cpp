#include "scenario/aim.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/world.hpp"

namespace brume::scenario {
namespace {

/// 10 m of open air with a wall of half a metre at x = 6 m.
voxel::BitGrid air_with_a_wall() {
  voxel::BitGrid grid({{20, 20, 20}, 0.5f, glm::vec3(0)});
  for (int z = 0; z < 20; ++z)
    for (int y = 0; y < 20; ++y) grid.set({12, y, z}, true);
  return grid;
}

TEST(Aim, MeetsTheFirstWallAndLandsBeforeIt) {
  const voxel::BitGrid grid = air_with_a_wall();
  const Aim at_wall = aim(grid, {1, 2.2f, 3.2f}, {2, 0, 0});
  EXPECT_NEAR(at_wall.at_world.x, 6, 1e-5);
  EXPECT_NEAR(at_wall.meets.value_or(0), 5, 1e-5);
  EXPECT_EQ(at_wall.landing_world, glm::vec3(5.75f, 2.25f, 3.25f));
  // The smoke goes off where the aim says.
  sim::World world(grid);
  world
      .append(sim::ThrowSmoke{0,
                              sim::position_from_metres({1, 2.2, 3.2}),
                              sim::position_from_metres(glm::dvec3(at_wall.at_world)),
                              {}})
      .value_or_throw();
  world.advance_to(0);
  ASSERT_EQ(world.state().flights.size(), 1u);
  EXPECT_EQ(glm::vec3(world.state().flights[0].landing) * 0.5f + 0.25f, *at_wall.landing_world);
}

TEST(Aim, LimitsTheRangeAndStaysWhereEventsAreValid) {
  const voxel::BitGrid grid = air_with_a_wall();
  const Aim into_air = aim(grid, {1, 2.2f, 3.2f}, {-1, 0, 0}, 3);
  EXPECT_EQ(into_air.meets, std::nullopt);
  EXPECT_NEAR(into_air.at_world.x, -2, 1e-5);
  EXPECT_EQ(into_air.landing_world, glm::vec3(0.25f, 2.25f, 3.25f)) << "the last voxel along the path";
  EXPECT_LE(aim(grid, {16383, 0, 0}, {1, 0, 0}).at_world.x, 16384);
  EXPECT_EQ(aim(grid, {16383, 0, 0}, {1, 0, 0}).landing_world, std::nullopt);
  // From within the wall, and without a direction: a shot still has one.
  const Aim in_wall = aim(grid, {6.25f, 2.2f, 3.2f}, {0, 0, 1});
  EXPECT_EQ(in_wall.meets, 0.0f);
  EXPECT_NEAR(in_wall.at_world.z, 3.45f, 1e-5);
  EXPECT_NEAR(aim(grid, {1, 2, 3}, glm::vec3(0)).at_world.z, -37, 1e-4);
  EXPECT_NEAR(aim(grid, {1, 2, 3}, {NAN, 0, 0}).at_world.z, -37, 1e-4);
}

}  // namespace
}  // namespace brume::scenario
