// What a world keeps when time runs backwards.
#include <gtest/gtest.h>

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

}  // namespace
}  // namespace brume::sim
