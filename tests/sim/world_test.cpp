#include "sim/world.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>

namespace brume::sim {
namespace {

using voxel::BitGrid;

Position metres(double x, double y, double z) {
  return position_from_metres({x, y, z});
}

/// 20 x 5 x 20 m at half a metre with a wall at x = 10 m that has a door.
BitGrid make_house() {
  BitGrid grid({{40, 10, 40}, 0.5f, glm::vec3(-3, 0, 2)});
  for (int z = 0; z < 40; ++z)
    for (int y = 0; y < 10; ++y)
      if (z < 18 || z > 20 || y > 4) grid.set({20, y, z}, true);
  return grid;
}

ThrowSmoke throw_at(std::uint32_t tick, Position from, Position at, std::uint32_t voxels = 1800) {
  return {tick, from, at, {voxels, 64}};
}

TEST(Landing, TakesTheFreeVoxelBeforeTheFirstSolidOne) {
  const BitGrid grid = make_house();
  // From x = 1 m towards the wall at voxel 20; `at` lies before, in and behind it.
  for (const double x : {3.0, 7.2, 15.0}) {
    const auto landing = landing_voxel(grid, glm::vec3(1, 1.2f, 5.2f), glm::vec3(x, 1.2f, 5.2f));
    EXPECT_EQ(landing, glm::ivec3(19, 2, 6));
  }
}

TEST(Landing, IsWhereItWasAimedWhenNothingStandsInTheWay) {
  const BitGrid grid = make_house();
  EXPECT_EQ(landing_voxel(grid, glm::vec3(8, 1, 4), glm::vec3(9.1f, 3.1f, 6.1f)), glm::ivec3(24, 6, 8));
  // Aimed at a point outside: the last voxel on the way.
  EXPECT_EQ(landing_voxel(grid, glm::vec3(8, 1.2f, 4.2f), glm::vec3(90, 1.2f, 4.2f)), glm::ivec3(39, 2, 4));
  // A ray that misses the grid.
  EXPECT_EQ(landing_voxel(grid, glm::vec3(-9, 1, 4), glm::vec3(-9, 1, 8)), std::nullopt);
}

TEST(Landing, FromASolidVoxelFindsAFreeOneAhead) {
  const BitGrid grid = make_house();
  const glm::vec3 in_wall(7.2f, 1.2f, 5.2f);
  EXPECT_EQ(landing_voxel(grid, in_wall, in_wall + glm::vec3(1, 0, 0)), glm::ivec3(21, 2, 6));
  EXPECT_EQ(landing_voxel(grid, in_wall, in_wall - glm::vec3(1, 0, 0)), glm::ivec3(19, 2, 6));
  BitGrid full({{3, 3, 3}, 0.5f, glm::vec3(0)});
  for (int i = 0; i < 27; ++i) full.set({i % 3, i / 3 % 3, i / 9}, true);
  EXPECT_EQ(landing_voxel(full, glm::vec3(0.7f), glm::vec3(5)), std::nullopt);
}

TEST(Walk, VisitsEveryVoxelOfTheRayInOrder) {
  const BitGrid grid({{17, 5, 33}, 0.37f, glm::vec3(-1.3f, 0.2f, 4)});
  const VoxelRuler ruler(grid.frame());
  std::mt19937 random(1);
  std::uniform_int_distribution<int> coordinate(-8000, 16000);
  for (int i = 0; i < 2000; ++i) {
    Position from(coordinate(random), coordinate(random), coordinate(random));
    Position to(coordinate(random), coordinate(random), coordinate(random));
    if (i % 3 == 0) to[i % 2] = from[i % 2];
    const glm::dvec3 start = glm::dvec3(ruler.subvoxel(from)) / 1024.0;
    const glm::dvec3 way = glm::dvec3(ruler.subvoxel(to)) / 1024.0 - start;
    glm::ivec3 last(0);
    double entry = 0;
    int steps = 0;
    walk_ray(grid, ruler, from, to, [&](const WalkStep& step) {
      EXPECT_TRUE(grid.contains(step.voxel));
      const double exit = static_cast<double>(step.exit.num) / static_cast<double>(step.exit.den);
      // Half way through, the ray is in this voxel.
      if (steps > 0) {
        const glm::dvec3 middle = start + way * ((entry + exit) / 2);
        EXPECT_TRUE(glm::all(glm::greaterThanEqual(middle, glm::dvec3(step.voxel) - 1e-9)));
        EXPECT_TRUE(glm::all(glm::lessThanEqual(middle, glm::dvec3(step.voxel) + 1.0 + 1e-9)));
        const glm::ivec3 moved = glm::abs(step.voxel - last);
        EXPECT_EQ(moved.x + moved.y + moved.z, 1);
        EXPECT_GE(exit, entry);
      }
      last = step.voxel;
      entry = exit;
      ++steps;
      return true;
    });
  }
}

TEST(World, RefusesEventsOutOfRange) {
  const BitGrid grid = make_house();
  World world(grid);
  EXPECT_FALSE(world.append(throw_at(0, {kMaxCoordinate + 1, 0, 0}, {0, 0, 0})));
  EXPECT_FALSE(world.append(throw_at(0, {0, std::numeric_limits<int>::min(), 0}, {0, 0, 0})));
  EXPECT_FALSE(world.append(throw_at(kMaxTick + 1, {0, 0, 0}, {1, 0, 0})));
  EXPECT_FALSE(world.append(throw_at(0, {0, 0, 0}, {1, 0, 0}, 0)));
  EXPECT_FALSE(world.append(throw_at(0, {0, 0, 0}, {1, 0, 0}, kMaxFillVoxels + 1)));
  EXPECT_FALSE(world.append(ThrowSmoke{0, {0, 0, 0}, {1, 0, 0}, {100, 0}}));
  EXPECT_FALSE(world.append(Shot{0, {5, 5, 5}, {5, 5, 5}}));
  EXPECT_FALSE(world.append(Shot{0, {5, 5, 5}, {5, 5, 6}, 0}));
  EXPECT_FALSE(world.append(Shot{0, {5, 5, 5}, {5, 5, 6}, 10, {250, 50, (1u << 30) + 1, 350}}));
  EXPECT_THROW(World(grid, {0}), Error);
  EXPECT_THROW(World(BitGrid({{3, 3, 3}, 0.5f, glm::vec3(1e9f)})), Error);
}

TEST(World, GrenadeFliesAt20MetresASecondAndGoesOff) {
  const BitGrid grid = make_house();
  World world(grid);
  const Position from = metres(-2, 1.25, 5.25);
  world.append(throw_at(10, from, metres(7, 1.25, 5.25))).value_or_throw();
  // Lands in voxel 19: its centre is at x = 6.75 m, 8.75 m away: 28 ticks of 1/64 s.
  ASSERT_EQ(world.detonation_tick(0), 38u);
  EXPECT_FALSE(world.grenade(0, 9));
  EXPECT_FALSE(world.grenade(0, 38));
  for (std::uint32_t tick = 10; tick < 38; ++tick) {
    const auto grenade = world.grenade(0, tick);
    ASSERT_TRUE(grenade);
    EXPECT_NEAR(grenade->position_world.x, -2 + 20.0 * (tick - 10) / 64, 0.01);
  }
  world.advance_to(37);
  EXPECT_EQ(world.grenades().size(), 1u);
  EXPECT_TRUE(world.clouds().empty());
  world.advance_to(38);
  EXPECT_TRUE(world.grenades().empty());
  EXPECT_EQ(world.clouds().size(), 1u);
}

TEST(Cloud, GrowsEveryTickWithoutAJumpAndHoldsItsAmount) {
  const BitGrid grid = make_house();
  const Cloud cloud(grid, {10, 4, 20}, {1800, 64}, 100);
  EXPECT_EQ(cloud.amount(100), 0u);
  EXPECT_EQ(cloud.amount(164), std::uint64_t{1800} << 20);
  EXPECT_EQ(cloud.amount(5000), std::uint64_t{1800} << 20);
  std::map<std::size_t, std::uint8_t> before;
  for (std::uint32_t tick = 101; tick <= 164; ++tick) {
    EXPECT_GT(cloud.amount(tick), cloud.amount(tick - 1));
    EXPECT_GT(cloud.front(tick), cloud.front(tick - 1)) << tick;
    // The nearest `amount` voxels lie within the front.
    const std::uint64_t whole = (cloud.amount(tick) + (1u << 20) - 1) >> 20;
    ASSERT_LE(whole, cloud.voxels().size());
    EXPECT_LE(cloud.voxels()[whole - 1].distance * kFrontUnit, cloud.front(tick));
    for (std::size_t i = 0; i < cloud.voxels().size(); ++i) {
      const std::uint8_t now = Cloud::density_at(cloud.voxels()[i].distance, cloud.front(tick));
      EXPECT_GE(now + 0, before[i] - 2);  // the taper widens with the front
      before[i] = now;
    }
  }
  EXPECT_EQ(cloud.front(164), cloud.front(1000000));
  EXPECT_EQ(before[0], 255);
  // The last voxels, where the fill ends in open air, are as good as empty.
  EXPECT_LE(before[1799], 1);
}

TEST(Cloud, FillsAClosedRoomWithFullDensity) {
  BitGrid grid({{12, 8, 12}, 0.5f, glm::vec3(0)});
  for (int i = 0; i < 12 * 8 * 12; ++i) {
    const glm::ivec3 v(i % 12, i / 12 % 8, i / 96);
    if (glm::any(glm::equal(v, glm::ivec3(0))) || glm::any(glm::equal(v, grid.size() - 1))) grid.set(v, true);
  }
  const Cloud cloud(grid, {5, 3, 5}, {1800, 64}, 0);
  EXPECT_EQ(cloud.voxels().size(), 600u);
  EXPECT_EQ(Cloud::density_at(cloud.voxels().back().distance, cloud.front(64)), 255);
}

TEST(Cloud, RampIsSmoothAndEndsAtZero) {
  for (const Front front : {Front{0}, Front{1}, Front{256 * 10}, Front{256 * 85}, Front{256 * 1000}}) {
    int last = 255;
    for (std::uint32_t distance = 0; distance < 1100; ++distance) {
      const int density = Cloud::density_at(distance, front);
      EXPECT_LE(density, last);
      EXPECT_TRUE(density == 0 || distance * kFrontUnit < front);
      last = density;
    }
  }
  EXPECT_EQ(Cloud::density_at(0, 256 * 20), 255);
  EXPECT_EQ(Cloud::density_at(10, 256 * 20), 128);  // half way through the least taper
}

/// Several smokes and many shots.
World busy_world(const BitGrid& grid) {
  World world(grid);
  std::mt19937 random(11);
  std::uniform_real_distribution<double> x(-2, 16), y(0.3, 4.5), z(3, 21);
  for (std::uint32_t i = 0; i < 8; ++i)
    world
        .append(throw_at(i * 20, metres(x(random), y(random), z(random)),
                         metres(x(random), y(random), z(random)), 400 + 200 * i))
        .value_or_throw();
  for (std::uint32_t i = 0; i < 60; ++i)
    world
        .append(Shot{40 + 5 * i, metres(x(random), y(random), z(random)),
                     metres(x(random), y(random), z(random))})
        .value_or_throw();
  return world;
}

TEST(World, StateIsAFunctionOfLogAndTick) {
  const BitGrid grid = make_house();
  World steady = busy_world(grid);
  std::vector<std::uint64_t> hashes;
  for (std::uint32_t tick = 0; tick < 500; ++tick) {
    steady.advance_to(tick);
    hashes.push_back(steady.state_hash());
  }
  World jumping = busy_world(grid);
  std::mt19937 random(2);
  for (int i = 0; i < 300; ++i) {
    const auto tick = static_cast<std::uint32_t>(random() % 500);
    jumping.advance_to(tick);
    ASSERT_EQ(jumping.state_hash(), hashes[tick]) << "tick " << tick;
  }
  // Every tick differs from the one before: clouds grow, grenades fly, and the tick itself counts.
  for (std::size_t i = 1; i < hashes.size(); ++i) EXPECT_NE(hashes[i], hashes[i - 1]);
}

TEST(World, EventsMayComeLate) {
  const BitGrid grid = make_house();
  World early(grid), late(grid);
  const ThrowSmoke smoke = throw_at(5, metres(0, 1, 10), metres(3, 1, 10));
  const Shot shot{60, metres(-2, 1, 10), metres(6, 1, 10)};
  early.append(smoke).value_or_throw();
  early.append(shot).value_or_throw();
  early.advance_to(90);
  late.advance_to(90);
  late.append(shot).value_or_throw();
  late.append(smoke).value_or_throw();
  EXPECT_EQ(early.holes().size(), 1u);
  EXPECT_EQ(late.state_hash(), early.state_hash());
}

TEST(World, OverlappingCloudsAddAndSaturate) {
  const BitGrid grid = make_house();
  World one(grid), two(grid);
  const ThrowSmoke smoke = throw_at(0, metres(0, 1, 10), metres(3, 1, 10), 300);
  one.append(smoke).value_or_throw();
  two.append(smoke).value_or_throw();
  two.append(smoke).value_or_throw();
  one.advance_to(200);
  two.advance_to(200);
  bool partial = false;
  for (const FilledVoxel& filled : one.clouds()[0].cloud->voxels()) {
    const int single = one.density(filled.voxel);
    partial |= single > 0 && single < 128;
    EXPECT_EQ(two.density(filled.voxel), std::min(255, 2 * single));
  }
  EXPECT_TRUE(partial);
  EXPECT_EQ(one.density({39, 9, 39}), 0);
  EXPECT_EQ(one.density({-1, 0, 0}), 0);
}

TEST(World, HoleRunsThroughTheSmokeToTheWallAndCloses) {
  const BitGrid grid = make_house();
  World world(grid);
  world.append(throw_at(0, metres(0, 1.2, 5.2), metres(7, 1.2, 5.2), 3000)).value_or_throw();
  // Along +x at z = 5.2 m: the wall's voxel 20 ends at x = 7.5 m.
  const Shot shot{200, metres(-2, 1.2, 5.2), metres(0, 1.2, 5.2)};
  world.append(shot).value_or_throw();
  world.advance_to(200);
  EXPECT_TRUE(world.holes().empty());
  world.advance_to(201);
  ASSERT_EQ(world.holes().size(), 1u);
  const shared::Hole hole = world.holes()[0];
  EXPECT_NEAR(hole.distance_to_far, 9.5, 0.01);
  EXPECT_NEAR(hole.forward.x, 1, 1e-6);
  EXPECT_NEAR(glm::dot(hole.forward, hole.right), 0, 1e-6);
  EXPECT_NEAR(glm::dot(glm::cross(hole.right, hole.forward), hole.up), 1, 1e-6);
  EXPECT_FLOAT_EQ(hole.time_start, 200.0f / 64);
  // 250 + 50 + 1000 + 350 ms are 105.6 ticks.
  world.advance_to(305);
  EXPECT_EQ(world.holes().size(), 1u);
  world.advance_to(306);
  EXPECT_TRUE(world.holes().empty());
}

TEST(World, ShotThatMeetsNoSmokeLeavesNoHole) {
  const BitGrid grid = make_house();
  World world(grid);
  world.append(Shot{0, metres(-2, 1.2, 5.2), metres(0, 1.2, 5.2)}).value_or_throw();  // no smoke yet
  world.append(throw_at(1, metres(0, 1.2, 5.2), metres(7, 1.2, 5.2), 100)).value_or_throw();
  world.append(Shot{90, metres(-2, 4, 20), metres(0, 4, 20)}).value_or_throw();         // far from it
  world.append(Shot{90, metres(16, 1.2, 5.2), metres(12, 1.2, 5.2)}).value_or_throw();  // behind the wall
  world.advance_to(95);
  for (const shared::Hole& hole : world.holes()) EXPECT_GT(hole.origin_world.x, 15);
  world.advance_to(10);
  EXPECT_TRUE(world.holes().empty());
}

}  // namespace
}  // namespace brume::sim
