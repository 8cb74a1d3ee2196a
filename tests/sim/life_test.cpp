// Clouds from their first tick to their last, doors and explosions in them.
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <random>
#include <vector>

#include "sim/level_edit.hpp"
#include "sim/world.hpp"

namespace brume::sim {
namespace {

using voxel::BitGrid;

constexpr SmokeSettings kShort{600, 32, 40, 64};

void set_box(BitGrid& grid, glm::ivec3 low, glm::ivec3 high, bool solid) {
  apply_edits(grid, edit_box(grid.layout(), low, high, solid));
}

/// A solid grid with one hole in it.
BitGrid solid_but(glm::ivec3 size, glm::ivec3 low, glm::ivec3 high) {
  BitGrid grid({size, 0.5f, glm::vec3(0)});
  set_box(grid, glm::ivec3(0), size, true);
  set_box(grid, low, high, false);
  return grid;
}

/// Rooms: a corridor, a hall, stairs, open space.
std::vector<BitGrid> rooms() {
  std::vector<BitGrid> all{
      solid_but({203, 7, 7}, {1, 1, 1}, {202, 6, 5}), solid_but({40, 20, 40}, {1, 1, 1}, {39, 19, 39}),
      solid_but({60, 40, 12}, {1, 1, 1}, {59, 39, 11}), BitGrid({{64, 33, 64}, 0.5f, glm::vec3(0)})};
  for (int step = 0; step < 28; ++step) set_box(all[2], {2 + 2 * step, 1, 1}, {59, 2 + step, 11}, true);
  return all;
}

glm::ivec3 first_free(const BitGrid& grid) {
  for (int i = 0;; ++i) {
    const glm::ivec3 v(i % grid.size().x, 1 + i / grid.size().x % 3, grid.size().z / 2);
    if (grid.free(v)) return v;
  }
}

int density_at(const Cloud& cloud, std::uint32_t rank, std::uint32_t tick) {
  return cloud.density(rank, cloud.phase(tick));
}

std::vector<int> densities(const Cloud& cloud, std::uint32_t tick) {
  std::vector<int> all(cloud.voxels().size());
  const CloudPhase phase = cloud.phase(tick);
  for (std::uint32_t rank = 0; rank < all.size(); ++rank) all[rank] = cloud.density(rank, phase);
  return all;
}

TEST(CloudLife, FillsItsVolumeInRoomsOfAnyShape) {
  for (const BitGrid& grid : rooms()) {
    for (const std::uint32_t voxels : {1u, 7u, 1800u}) {
      const Cloud cloud(grid, {first_free(grid), {voxels, 64, 100, 50}, 10});
      EXPECT_EQ(cloud.voxels().size(), voxels);
      EXPECT_EQ(cloud.amount(10), 0u);
      EXPECT_EQ(cloud.amount(74), std::uint64_t{voxels} << 20);
      cloud.voxels().for_each([&](glm::ivec3 v, std::uint32_t) { EXPECT_TRUE(grid.free(v)); });
    }
  }
  // Fills a room that is too small completely.
  const BitGrid cell = solid_but({12, 8, 12}, {1, 1, 1}, {11, 7, 11});
  const Cloud cloud(cell, {{5, 3, 5}, {1800, 64, 100, 50}, 0});
  EXPECT_EQ(cloud.voxels().size(), 600u);
  for (const int density : densities(cloud, 64)) EXPECT_EQ(density, 255);
  EXPECT_TRUE(Cloud(cell, {{0, 0, 0}, {}, 0}).voxels().empty());
}

TEST(CloudLife, GrowsEveryTickAndFastestAtFirst) {
  const BitGrid grid = rooms()[1];
  const Cloud cloud(grid, {{20, 3, 20}, {1800, 64, 100, 50}, 100});
  EXPECT_GT(cloud.amount(132), cloud.amount(164) / 2);
  for (std::uint32_t tick = 101; tick <= 164; ++tick) {
    EXPECT_GT(cloud.amount(tick), cloud.amount(tick - 1));
    EXPECT_GT(cloud.phase(tick).front, cloud.phase(tick - 1).front) << tick;
    // The nearest `amount` voxels lie within the front.
    const auto whole = static_cast<std::size_t>((cloud.amount(tick) + (1u << 20) - 1) >> 20);
    std::vector<std::uint32_t> distances(cloud.distances().begin(), cloud.distances().end());
    std::sort(distances.begin(), distances.end());
    ASSERT_LE(whole, distances.size());
    EXPECT_LE(distances[whole - 1] * kFrontUnit, cloud.phase(tick).front);
  }
  for (std::uint32_t tick = 164; tick <= 264; tick += 20)
    EXPECT_EQ(densities(cloud, tick), densities(cloud, 164)) << "it holds";
  EXPECT_EQ(density_at(cloud, cloud.voxels().rank({20, 3, 20}), 164), 255);
}

TEST(CloudLife, ProfileFallsFromFullToZero) {
  for (const Front front : {Front{0}, Front{1}, Front{256 * 10}, Front{256 * 85}, Front{256 * 1000}}) {
    int last = 255;
    for (std::uint32_t distance = 0; distance < 1100; ++distance) {
      const int density = Cloud::profile(distance, front);
      EXPECT_LE(density, last);
      EXPECT_TRUE(density == 0 || distance * kFrontUnit < front);
      last = density;
    }
  }
  EXPECT_EQ(Cloud::profile(0, 256 * 20), 255);
  EXPECT_EQ(Cloud::profile(10, 256 * 20), 128);  // halfway through the shortest taper
}

// The front lags by up to a quarter of the distance, depending on the direction only, so that lobes grow with
// the cloud.
TEST(CloudLife, BulgesInLobes) {
  const BitGrid grid({glm::ivec3(81), 0.25f, glm::vec3(0)});
  const glm::ivec3 source(40);
  const Cloud cloud(grid, {source, {100000, 64, 100, 192}, 0});
  const auto lag = [&](glm::ivec3 offset) {
    const std::uint32_t rank = cloud.voxels().rank(source + offset);
    return static_cast<double>(cloud.reach(rank)) / cloud.distances()[rank] - 1;
  };
  double least = 1, most = 0;
  for (int i = 0; i < 343; ++i) {
    const glm::ivec3 offset(i % 7 - 3, i / 7 % 7 - 3, i / 49 - 3);
    if (offset == glm::ivec3(0)) continue;
    const double near = lag(4 * offset), far = lag(6 * offset);
    // Reaches are integers, and points on the sphere are quantized to 1/256 of a cell.
    EXPECT_NEAR(near, far, 1.0 / 40 + 1.0 / 100) << i;
    least = std::min(least, far);
    most = std::max(most, far);
  }
  EXPECT_GE(least, 0);
  EXPECT_LE(most, 0.25);
  EXPECT_GT(most - least, 0.15) << "lobes";
}

TEST(CloudLife, DissolvesMonotonicallyFromTheEdges) {
  for (const BitGrid& grid : rooms()) {
    const Cloud cloud(grid, {first_free(grid), {1800, 64, 100, 192}, 0});
    const std::uint32_t begin = 164;
    ASSERT_EQ(cloud.end_tick(), begin + 192);
    std::vector<int> before = densities(cloud, begin);
    std::vector<std::uint32_t> gone(before.size(), 0);
    for (std::uint32_t tick = begin + 1; tick <= cloud.end_tick(); ++tick) {
      const std::vector<int> now = densities(cloud, tick);
      for (std::size_t i = 0; i < now.size(); ++i) {
        ASSERT_LE(now[i], before[i]);
        if (now[i] == 0 && gone[i] == 0) gone[i] = tick;
      }
      before = now;
    }
    EXPECT_EQ(*std::max_element(before.begin(), before.end()), 0) << "nothing is left";
    // The farther half vanishes earlier on average.
    std::vector<std::uint32_t> order(gone.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](auto a, auto b) { return cloud.distances()[a] < cloud.distances()[b]; });
    double sums[2] = {};
    for (std::size_t i = 0; i < order.size(); ++i) sums[i * 2 / order.size()] += gone[order[i]];
    EXPECT_GT(sums[0], sums[1] * 1.05);
  }
}

// Half of a ball that shrinks to its source would be 0.79 times as far from it on average; smoke that thins
// in place stays where it was. Edges may go first.
TEST(CloudLife, ThinsWhereItStands) {
  for (const BitGrid& grid : rooms()) {
    const Cloud cloud(grid, {first_free(grid), {1800, 64, 100, 192}, 0});
    const auto amount_and_distance = [&](std::uint32_t tick) {
      const std::vector<int> now = densities(cloud, tick);
      double amount = 0, distance = 0;
      for (std::size_t i = 0; i < now.size(); ++i) {
        amount += now[i];
        distance += static_cast<double>(cloud.distances()[i]) * now[i];
      }
      return std::pair(amount, distance / amount);
    };
    const auto [all, far] = amount_and_distance(164);
    std::uint32_t half = 164;
    while (amount_and_distance(half).first > 0.5 * all) ++half;
    EXPECT_GT(amount_and_distance(half).second, 0.9 * far);
    EXPECT_LT(amount_and_distance(half).second, far);
  }
}

TEST(CloudLife, LeavesTheWorldEmpty) {
  const BitGrid grid = rooms()[1];
  World world(grid);
  world.append(ThrowSmoke{0, {5000, 2000, 5000}, {9000, 1000, 9000}, kShort}).value_or_throw();
  world.append(Blast{50, {9000, 1500, 9000}}).value_or_throw();
  world.append(Shot{50, {5000, 1500, 5000}, {9000, 1500, 9000}}).value_or_throw();
  world.advance_to(60);
  EXPECT_EQ(world.state().clouds.size(), 1u);
  EXPECT_EQ(world.state().blasts.size(), 1u);
  EXPECT_EQ(world.state().holes.size(), 1u);
  world.advance_to(world.state().clouds[0].cloud->end_tick() - 1);
  ASSERT_EQ(world.state().clouds.size(), 1u);
  world.step();
  EXPECT_TRUE(world.state().clouds.empty());
  world.advance_to(2000);
  const State& state = world.state();
  EXPECT_TRUE(state.clouds.empty() && state.blasts.empty() && state.holes.empty() && state.flights.empty());
}

TEST(CloudLife, OverlappingCloudsAddUpAndSaturate) {
  const BitGrid grid = rooms()[3];
  World one(grid), two(grid);
  const ThrowSmoke smoke{0, {15000, 8000, 15000}, {16000, 8000, 16000}, {300, 64, 1000, 100}};
  one.append(smoke).value_or_throw();
  two.append(smoke).value_or_throw();
  two.append(smoke).value_or_throw();
  one.advance_to(200);
  two.advance_to(200);
  bool partial = false;
  ASSERT_EQ(one.state().clouds.size(), 1u);
  one.state().clouds[0].cloud->voxels().for_each([&](glm::ivec3 voxel, std::uint32_t) {
    const int single = one.state().density(voxel);
    partial |= single > 0 && single < 128;
    EXPECT_EQ(two.state().density(voxel), std::min(255, 2 * single));
  });
  EXPECT_TRUE(partial);
  EXPECT_EQ(one.state().density({63, 32, 63}), 0);
  EXPECT_EQ(one.state().density({-1, 0, 0}), 0);
}

TEST(CloudLife, TenThousandSimultaneousClouds) {
  const BitGrid grid({{512, 64, 512}, 0.5f, glm::vec3(0)});
  World world(grid);
  for (int i = 0; i < 10000; ++i) {
    const Position at(1000 + i % 100 * 2600, 16000, 1000 + i / 100 * 2600);
    // In the future: an event of the current tick would simulate that tick again.
    world.append(ThrowSmoke{1, at, at + Position(1, 0, 0), {27, 8, 100, 8}}).value_or_throw();
  }
  world.advance_to(50);
  ASSERT_EQ(world.state().clouds.size(), 10000u);
  for (std::uint32_t i = 0; i < 10000; i += 997) {
    EXPECT_EQ(world.state().clouds[i].id, i);
    EXPECT_EQ(world.state().clouds[i].cloud->voxels().size(), 27u);
    EXPECT_GT(world.state().density(world.state().clouds[i].cloud->origin().source), 0);
  }
  world.advance_to(500);
  EXPECT_TRUE(world.state().clouds.empty());
}

/// Two closed rooms of 20 x 8 x 16 voxels, the wall between them at x = 21, the door in it.
struct TwoRooms {
  BitGrid grid = solid_but({43, 10, 18}, {1, 1, 1}, {42, 9, 17});
  EditBlocks open, shut;
  TwoRooms() {
    set_box(grid, {21, 1, 1}, {22, 9, 17}, true);
    open = edit_box(grid.layout(), {21, 1, 7}, {22, 5, 10}, false);
    shut = edit_box(grid.layout(), {21, 1, 7}, {22, 5, 10}, true);
  }
  static std::uint32_t beyond(const Cloud& cloud) {
    std::uint32_t count = 0;
    cloud.voxels().for_each([&](glm::ivec3 v, std::uint32_t) { count += v.x > 21; });
    return count;
  }
};

/// Lands on the floor.
const ThrowSmoke kInTheFirstRoom{0, {2000, 1000, 4000}, {8000, 300, 4300}, {3000, 64, 2000, 100}};

TEST(Doors, SmokeFlowsThroughAnOpenDoorAndKeepsItsVolume) {
  const TwoRooms rooms;
  World world(rooms.grid);
  world.append(kInTheFirstRoom).value_or_throw();
  world.append(LevelEdit{200, rooms.open}).value_or_throw();
  world.advance_to(199);
  ASSERT_EQ(world.state().clouds.size(), 1u);
  EXPECT_EQ(world.state().clouds[0].cloud->voxels().size(), 20u * 8 * 16);
  EXPECT_EQ(TwoRooms::beyond(*world.state().clouds[0].cloud), 0u);
  world.advance_to(200);
  ASSERT_TRUE(world.state().clouds[0].cloud->settle_tick());
  world.advance_to(*world.state().clouds[0].cloud->settle_tick());
  const Cloud& cloud = *world.state().clouds[0].cloud;
  EXPECT_FALSE(cloud.settle_tick());
  EXPECT_EQ(cloud.parts().fill.size() + cloud.parts().detached.size(), 3000u);
  EXPECT_GT(TwoRooms::beyond(cloud), 300u);
  // Equals a world in which the door was always open.
  BitGrid opened = rooms.grid;
  apply_edits(opened, rooms.open);
  EXPECT_EQ(cloud.voxels(), Cloud(opened, cloud.origin()).voxels());
}

TEST(Doors, DensityChangesSmoothlyWhileSmokeFlowsThrough) {
  const TwoRooms rooms;
  World world(rooms.grid);
  world.append(kInTheFirstRoom).value_or_throw();
  world.append(LevelEdit{200, rooms.open}).value_or_throw();
  world.advance_to(199);
  const State before = world.state();
  world.step();
  world.state().clouds[0].cloud->voxels().for_each([&](glm::ivec3 v, std::uint32_t) {
    // A voxel turns in a quarter of the bloom: 16 ticks, 16 steps a tick on average, 1.5 times that at
    // the middle of a smoothstep.
    EXPECT_NEAR(world.state().density(v), before.density(v), 24);
  });
}

TEST(Doors, ClosingKeepsSmokeOnBothSides) {
  TwoRooms rooms;
  apply_edits(rooms.grid, rooms.open);
  World world(rooms.grid);
  world.append(kInTheFirstRoom).value_or_throw();
  world.append(LevelEdit{300, rooms.shut}).value_or_throw();
  world.advance_to(299);
  // Lobes leave some voxels of the region empty.
  std::uint32_t held = 0;
  world.state().clouds[0].cloud->voxels().for_each([&](glm::ivec3 v, std::uint32_t) {
    if (v.x > 21 && world.state().density(v) > 0) ++held;
  });
  ASSERT_GT(held, 200u);
  world.advance_to(1500);
  const Cloud& cloud = *world.state().clouds[0].cloud;
  std::uint32_t trapped = 0;
  cloud.parts().detached.for_each([&](glm::ivec3 v, std::uint32_t rank) {
    EXPECT_GT(v.x, 21);
    EXPECT_EQ(world.state().density(v), cloud.parts().detached_base[rank]);
    ++trapped;
  });
  EXPECT_EQ(trapped, held);
  EXPECT_LE(cloud.parts().fill.size() + trapped, 3000u);
  for (int y = 1; y < 5; ++y) EXPECT_EQ(world.state().density({21, y, 8}), 0) << "in the door";
  // The detached voxels vanish with the smoke.
  world.advance_to(cloud.end_tick());
  EXPECT_TRUE(world.state().clouds.empty());
}

TEST(Blasts, DoNotAffectSmokeBehindAWall) {
  const TwoRooms rooms;
  World world(rooms.grid);
  world.append(kInTheFirstRoom).value_or_throw();
  ThrowSmoke second = kInTheFirstRoom;
  second.from.x = 13000;
  second.at.x = 19000;
  world.append(second).value_or_throw();
  // In the second room, half a metre behind the wall.
  world.append(Blast{200, {11600, 2048, 4400}}).value_or_throw();
  world.advance_to(200);
  const State before = world.state();
  int least = 255;
  for (std::uint32_t tick = 200; tick < 620; tick += 4) {
    world.advance_to(tick);
    for (int x = 1; x < 21; ++x)
      for (int z = 1; z < 17; ++z) EXPECT_EQ(world.state().density({x, 4, z}), before.density({x, 4, z}));
    least = std::min<int>(least, world.state().density({23, 4, 8}));
  }
  EXPECT_EQ(least, 5);  // Blast::remaining without a wall
}

TEST(Blasts, OpenAtTheSpeedOfTheFrontAndRefillFromTheRim) {
  BitGrid grid = solid_but({44, 24, 44}, {2, 2, 2}, {42, 22, 42});
  World world(grid);
  world.append(ThrowSmoke{0, {11000, 6000, 11000}, {11300, 6000, 11300}, {100000, 1, 3000, 10}})
      .value_or_throw();
  // 4 m at 8 m/s: the rim is reached after half a second, and full again half a second later.
  const Blast blast{100, {11264 + 256, 6144 + 256, 11264 + 256}, 4096, 8192, 20, 500, 2000};
  world.append(blast).value_or_throw();
  const auto at = [&](std::uint32_t tick, int voxels_away) {
    world.advance_to(tick);
    return int{world.state().density({22 + voxels_away, 12, 22})};
  };
  ASSERT_EQ(at(100, 0), 255);
  for (const int away : {0, 2, 4, 6, 7}) {
    // The front arrives after away / 2 m / (8 m/s) = 4 away ticks, a reach of 1/255 rounds that by 0.16
    // ticks; 50 ms later, 3.2 ticks, it is open.
    const auto arrival = 100 + 4 * static_cast<std::uint32_t>(away);
    EXPECT_EQ(at(arrival - (away > 0 ? 1 : 0), away), 255) << away;
    EXPECT_LE(at(arrival + 5, away), 30) << away;
  }
  for (int away = 10; away < 18; ++away)
    for (std::uint32_t tick = 100; tick < 300; tick += 10) EXPECT_EQ(at(tick, away), 255) << away;
  // The rim first: at any time in the refill, less in the middle.
  for (std::uint32_t tick = 150; tick < 250; tick += 10)
    for (int away = 1; away < 8; ++away) EXPECT_GE(at(tick, away), at(tick, away - 1)) << tick;
  world.advance_to(200);
  ASSERT_EQ(world.state().blasts.size(), 1u);
  const auto field = world.state().blasts[0].field;
  // The rim lies at 0.5 s, opens in 0.05 s, refills in 0.5 s; the middle in 2 s from the start.
  EXPECT_NEAR(at(100 + 68, 8), 255, 3);
  EXPECT_LT(at(100 + 68, 0), 200);
  EXPECT_NEAR(field->end_tick(), 100 + 132, 2);
  world.advance_to(field->end_tick());
  EXPECT_TRUE(world.state().blasts.empty());
}

}  // namespace
}  // namespace brume::sim
