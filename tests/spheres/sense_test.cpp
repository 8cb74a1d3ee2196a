// What eyes see of a tank.
#include "spheres/sense.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "core/tasks.hpp"
#include "spheres/color.hpp"
#include "tests/spheres/test_tanks.hpp"

namespace brume::spheres {
namespace {

using glm::vec3;

struct SensedTank {
  explicit SensedTank(Tank with)
      : tank(std::move(with)), bricks(list_bricks(tank)), ids(make_ids(tank, bricks)) {}
  TankView view() const { return {tank, bricks, ids}; }
  Tank tank;
  BrickLists bricks;
  VoxelIds ids;
};

// Along x: a medium from 5 to 11 voxels, an opaque ball from 18 to 22; voxels of 0.5 m, middle at the origin.
SensedTank line_of_two(Color first, Color second) {
  Tank tank;
  tank.size = {32, 8, 8};
  tank.voxel = 0.5f;
  tank.spheres = {{{8, 4, 4}, 3}, {{20, 4, 4}, 2}};
  tank.colors = {first, second};
  return SensedTank(tank);
}

constexpr float kInfinity = std::numeric_limits<float>::infinity();

TEST(SenseRay, SeesAnOpaqueSphereThroughAMedium) {
  // 1 - 51 / 255 = 0.8 per voxel, 6 voxels long.
  const SensedTank tank = line_of_two(0x33ff0000u, 0xff00ff00u);
  const double passes = std::pow(0.8, 6);
  const Sensed seen = sense_ray(tank.view(), {-10, 0, 0}, {1, 0, 0});
  EXPECT_NEAR(seen.color.z, 1 - passes, 1e-6);  // blue medium
  EXPECT_NEAR(seen.color.y, passes, 1e-6);      // green ball
  EXPECT_EQ(seen.color.x, 0);
  EXPECT_EQ(seen.opacity, 1);
  // Half is taken where 0.8^l = 1/2, from the medium's surface at -5.5 m on.
  EXPECT_NEAR(seen.depth, 4.5 + 0.5 * std::log(0.5) / std::log(0.8), 1e-5);
}

TEST(SenseRay, OfAThinMediumSeesTheDepthOfWhatIsBehind) {
  const SensedTank tank = line_of_two(0x0dff0000u, 0xff00ff00u);  // 0.949^6 = 0.73
  EXPECT_NEAR(sense_ray(tank.view(), {-10, 0, 0}, {3, 0, 0}).depth, 11, 1e-5);
  const Sensed across = sense_ray(tank.view(), {-4, 0, 9}, {0, 0, -1});
  EXPECT_EQ(across.depth, kInfinity);
  EXPECT_NEAR(across.opacity, 1 - std::pow(1 - 13.0 / 255, 6), 1e-6);
}

TEST(SenseRay, SeesNothingWhereNothingIs) {
  const SensedTank tank = line_of_two(0x00ffffffu, 0xffffffffu);
  const Sensed away = sense_ray(tank.view(), {-10, 0, 0}, {-1, 0, 0});
  EXPECT_EQ(away.color, vec3(0));
  EXPECT_EQ(away.opacity, 0);
  EXPECT_EQ(away.depth, kInfinity);
  EXPECT_NEAR(sense_ray(tank.view(), {-10, 0, 0}, {1, 0, 0}).depth, 11, 1e-5);  // not the clear one
  EXPECT_EQ(sense_ray(tank.view(), {2, 0, 0}, {1, 0, 0}).depth, 0);             // inside of the ball
}

TEST(Sense, LooksAsCamerasDo) {
  Tank balls;
  balls.size = {16, 16, 16};
  balls.voxel = 1;
  balls.spheres = {{{8, 13, 8}, 2}, {{13, 8, 8}, 2}};  // above and to the right of the middle
  balls.colors = {0xff0000ffu, 0xff00ff00u};
  const SensedTank tank(balls);
  const Eye eye{{0, 0, 20}, {0, 0, 0}, 2 * std::atan(8.0f / 20), {33, 17}};
  const std::vector<Sensed> seen = sense(tank.view(), eye);
  ASSERT_EQ(seen.size(), 33u * 17);
  // Half of the height are 8 voxels at the tank's middle: the upper ball's is at 5 / 8 of it.
  const auto row = static_cast<std::size_t>((1 - 5.0 / 8) / 2 * 17);
  EXPECT_EQ(seen[row * 33 + 16].color, vec3(1, 0, 0));
  EXPECT_NEAR(seen[row * 33 + 16].depth, 19, 1);
  const double tan_x = 8.0 * 33 / 17;
  EXPECT_EQ(seen[8 * 33 + static_cast<std::size_t>((1 + 5 / tan_x) / 2 * 33)].color, vec3(0, 1, 0));
  EXPECT_EQ(seen[8 * 33 + 16].opacity, 0);
  EXPECT_EQ(seen[0].depth, kInfinity);
}

TEST(Sense, IsTheSameForAnyNumberOfThreads) {
  Random random(1);
  const SensedTank tank(thrown_tank({60, 40, 30}, 500, 0.3f, 6, random));
  const Eye eye{{0.1f, 0.05f, 0.2f}, {0, 0, 0}, 1, {61, 33}};
  std::vector<Sensed> first;
  for (const unsigned threads : {1u, 2u, 8u}) {
    set_thread_count(threads);
    const std::vector<Sensed> seen = sense(tank.view(), eye);
    if (threads == 1) first = seen;
    for (std::size_t i = 0; i < seen.size(); ++i) {
      ASSERT_EQ(seen[i].color, first[i].color);
      ASSERT_EQ(seen[i].depth, first[i].depth);
    }
  }
  set_thread_count(0);
}

}  // namespace
}  // namespace brume::spheres
