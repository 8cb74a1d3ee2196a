// What a world keeps when time runs backwards.
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "sim/world.hpp"

namespace brume::sim {
namespace {

Position metres(double x, double y, double z) {
  return position_from_metres({x, y, z});
}

ThrowSmoke throw_at(std::uint32_t tick, Position from, Position at, std::uint32_t voxels) {
  return {tick, from, at, {voxels, 64, 1152, 192}};
}

TEST(World, MovingForwardAgainMakesNoLargeCloudTwice) {
  const voxel::BitGrid grid({{80, 64, 80}, 0.5f, glm::vec3(0)});
  World world(grid);
  const auto added = world.append({throw_at(3, metres(2, 2, 2), metres(20, 16, 20), 1u << 18),
                                   throw_at(150, metres(2, 2, 2), metres(3, 2, 2), 100)});
  ASSERT_TRUE(added) << added.failure().message;
  world.advance_to(200);
  ASSERT_EQ(world.state().clouds.size(), 2u);
  const auto cloud = world.state().clouds[0].cloud;
  const std::uint64_t hash = world.state_hash();
  world.advance_to(1);
  EXPECT_TRUE(world.state().clouds.empty());
  world.advance_to(200);
  ASSERT_EQ(world.state().clouds.size(), 2u);
  EXPECT_EQ(world.state().clouds[0].cloud, cloud) << "made again";
  EXPECT_EQ(world.state_hash(), hash);

  // Unless the log changed before it.
  ASSERT_TRUE(world.replace_from(0, {throw_at(3, metres(2, 2, 2), metres(21, 16, 20), 1u << 18)}));
  ASSERT_EQ(world.state().clouds.size(), 1u);
  EXPECT_NE(world.state().clouds[0].cloud, cloud);
}

/// Smokes on both sides of a wall with a doorway, every few ticks.
std::vector<Event> smokes_at_a_door() {
  std::vector<Event> events;
  for (std::uint32_t i = 0; i < 12; ++i) {
    const Position at = metres(i % 2 == 0 ? 4 : 7, 1, 3 + 0.5 * i);
    events.push_back(throw_at(3 + 7 * i, at, at, 300));
  }
  return events;
}

voxel::BitGrid walled() {
  voxel::BitGrid grid({{24, 8, 24}, 0.5f, glm::vec3(0)});
  apply_edits(grid, edit_box(grid.layout(), {11, 0, 0}, {12, 8, 24}, true));
  return grid;
}

LevelEdit door_at(std::uint32_t tick, bool solid) {
  return {tick, edit_box({{24, 8, 24}, 0.5f, glm::vec3(0)}, {11, 0, 8}, {12, 4, 12}, solid)};
}

TEST(World, ALateEventMakesNoOtherCloudAgain) {
  const voxel::BitGrid grid = walled();
  World world(grid);
  ASSERT_TRUE(world.append(smokes_at_a_door()));
  ASSERT_TRUE(world.append(door_at(40, false)));
  world.advance_to(44);
  const std::vector<LiveCloud> before = world.state().clouds;
  ASSERT_EQ(before.size(), 6u);
  EXPECT_TRUE(std::ranges::any_of(before, [](const LiveCloud& live) {
    return live.cloud->settle_tick().has_value();
  })) << "some flow through the door";
  ASSERT_TRUE(world.append(throw_at(20, metres(2, 1, 2), metres(2, 1, 2), 200)));
  ASSERT_EQ(world.state().clouds.size(), 7u);
  for (const LiveCloud& live : before)
    EXPECT_TRUE(std::ranges::any_of(world.state().clouds,
                                    [&](const LiveCloud& other) { return other.cloud == live.cloud; }))
        << live.id << " was made again";
}

// A door that has moved in the past: what was made for another level does not count.
TEST(World, ALateEditMakesTheCloudsThatFollow) {
  const voxel::BitGrid grid = walled();
  for (const std::uint32_t first : {0u, 10u, 45u})
    for (const std::uint32_t second : {12u, 50u, 80u}) {
      World straight(grid), late(grid);
      std::vector<Event> events = smokes_at_a_door();
      ASSERT_TRUE(late.append(events));
      late.advance_to(100);
      for (const LevelEdit& door : {door_at(first, false), door_at(second, true)}) {
        events.emplace_back(door);
        ASSERT_TRUE(late.append(door));
      }
      ASSERT_TRUE(straight.append(events));
      straight.advance_to(100);
      EXPECT_EQ(late.state_hash(), straight.state_hash()) << first << ", " << second;

      // And back, by replacing all events.
      ASSERT_TRUE(late.replace_from(0, smokes_at_a_door()));
      World shut(grid);
      ASSERT_TRUE(shut.append(smokes_at_a_door()));
      shut.advance_to(100);
      EXPECT_EQ(late.state_hash(), shut.state_hash()) << first << ", " << second;
    }
}

}  // namespace
}  // namespace brume::sim
