#include "scenario/walker.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <random>
#include <set>

#include "scenario/body_sweep.hpp"
#include "scenario/scenario.hpp"

namespace brume::scenario {
namespace {

using glm::dvec3;
using glm::ivec3;
using glm::vec3;
using voxel::BitGrid;

/// A grid of some metres from an origin, all free.
BitGrid space(float voxel, vec3 metres, vec3 origin = vec3(0)) {
  return BitGrid({glm::max(ivec3(glm::ceil(metres / voxel - 1e-3f)), ivec3(1)), voxel, origin});
}

/// Makes solid every voxel whose centre lies in a box [m].
void fill(BitGrid& grid, vec3 low, vec3 high) {
  for_each_in({ivec3(0), grid.size()}, [&](ivec3 v) {
    const vec3 centre = world_from_voxel(grid.layout(), vec3(v) + 0.5f);
    if (glm::all(glm::greaterThan(centre, low)) && glm::all(glm::lessThan(centre, high))) grid.set(v, true);
  });
}

Body body_of(const Walker& walker) {
  const dvec3 feet(walker.feet_world());
  const WalkerOptions& o = walker.options();
  // Rounding to float and kSkin amount to less than 1e-6 m for coordinates below 16 m.
  const double half = double{o.half_width} - 2e-6;
  return {feet + dvec3(-half, 2e-6, -half), feet + dvec3(half, double{o.height} - 2e-6, half)};
}

bool is_in_solid(const BitGrid& grid, vec3 p) {
  const ivec3 v(glm::floor(voxel_from_world(grid.layout(), p)));
  return v.y < 0 || grid.solid(v);
}

Walker at(const BitGrid& grid, vec3 feet, const WalkerOptions& options = {}) {
  Walker walker(options);
  walker.put(grid, feet + vec3(0, options.eye, 0));
  return walker;
}

void walk(Walker& walker, const BitGrid& grid, vec3 direction, double seconds, double layout = 1.0 / 60) {
  for (double time = 0; time < seconds - 1e-9; time += layout)
    walker.move(grid, {direction, false, false}, std::min(layout, seconds - time));
}

TEST(Walker, StandsOnTheFloorOfTheGridAndBesideIt) {
  for (const float voxel : {0.25f, 10.0f}) {
    const BitGrid grid = space(voxel, vec3(10, 4, 10), vec3(0, 1, 0));
    for (const vec3 place : {vec3(5, 3, 5), vec3(-7, 3, 100)}) {
      Walker walker = at(grid, place);
      EXPECT_FALSE(walker.on_ground());
      walk(walker, grid, vec3(0), 2);
      EXPECT_TRUE(walker.on_ground());
      EXPECT_NEAR(walker.feet_world().y, 1, 2e-5);
      EXPECT_NEAR(walker.eye_world().y, 2.62f, 2e-5);
      EXPECT_EQ(walker.velocity().y, 0);
    }
  }
}

TEST(Walker, FallIsIndependentOfTheFrameRate) {
  const BitGrid grid = space(0.5f, vec3(4, 60, 4));
  for (const double layout : {1.0 / 240, 1.0 / 61, 0.3, 0.75}) {
    Walker walker = at(grid, {2, 50, 2});
    walk(walker, grid, vec3(0), 1.5, layout);
    EXPECT_NEAR(walker.feet_world().y, 50 - 0.5 * 9.81 * 1.5 * 1.5, 1e-4) << layout;
    EXPECT_NEAR(walker.velocity().y, -9.81 * 1.5, 1e-4) << layout;
    walk(walker, grid, vec3(0), 3, layout);
    EXPECT_NEAR(walker.feet_world().y, 0, 2e-5) << layout;
  }
}

TEST(Walker, StopsAtAWallAndSlidesAlongIt) {
  BitGrid grid = space(0.125f, vec3(8, 4, 8));
  fill(grid, {5, 0, 0}, {5.25f, 3, 8});
  Walker walker = at(grid, {3, 0, 2});
  walk(walker, grid, vec3(1, 0, 1), 2);
  EXPECT_NEAR(walker.feet_world().x, 4.8f, 3e-5) << "a wall at 5 m, half a body of 0.2 m";
  EXPECT_GT(walker.feet_world().z, 2 + 3.5f * 0.707f * 1.8f) << "as fast along it as without it";
  // Into the corner, and out of it.
  fill(grid, {0, 0, 7.5f}, {8, 3, 7.75f});
  walk(walker, grid, vec3(1, 0, 1), 2);
  EXPECT_NEAR(walker.feet_world().x, 4.8f, 3e-5);
  EXPECT_NEAR(walker.feet_world().z, 7.3f, 3e-5);
  walk(walker, grid, vec3(-1, 0, -1), 0.5);
  EXPECT_LT(walker.feet_world().x, 3.9f);
  EXPECT_LT(walker.feet_world().z, 6.4f);
}

/// Stairs of ten steps along x from 2 m on, and a floor behind them.
BitGrid stairs(float voxel, float rise, float tread) {
  BitGrid grid = space(voxel, vec3(12, 10, 3));
  for (int i = 0; i < 10; ++i)
    fill(grid, {2 + tread * static_cast<float>(i), 0, 0}, {12, rise * static_cast<float>(i + 1), 3});
  return grid;
}

TEST(Walker, ClimbsAndDescendsStairsWithoutLosingContact) {
  for (const auto& [voxel, rise, tread] :
       {std::array{0.25f, 0.25f, 0.25f}, std::array{0.5f, 0.5f, 0.5f}, std::array{0.0625f, 0.1875f, 0.25f}}) {
    SCOPED_TRACE(rise);
    const BitGrid grid = stairs(voxel, rise, tread);
    Walker walker = at(grid, {1, 0, 1.5f});
    walk(walker, grid, vec3(0), 0.2);
    // Up: the eye rises without a jump.
    float last = walker.eye_world().y, highest_jump = 0;
    for (int i = 0; i < 150; ++i) {
      walker.move(grid, {vec3(1, 0, 0), false, false}, 1.0 / 60);
      EXPECT_TRUE(walker.on_ground());
      highest_jump = std::max(highest_jump, std::abs(walker.eye_world().y - last));
      last = walker.eye_world().y;
    }
    EXPECT_NEAR(walker.feet_world().y, 10 * rise, 2e-5);
    EXPECT_GT(walker.feet_world().x, 2 + 10 * tread);
    EXPECT_LT(highest_jump, 0.5f * rise) << "of a step at once";
    walk(walker, grid, vec3(0), 1);
    EXPECT_NEAR(walker.eye_world().y, 10 * rise + 1.62f, 1e-3);
    // Down: never in the air.
    for (int i = 0; i < 180; ++i) {
      walker.move(grid, {vec3(-1, 0, 0), false, false}, 1.0 / 60);
      ASSERT_TRUE(walker.on_ground()) << i;
    }
    EXPECT_NEAR(walker.feet_world().y, 0, 2e-5);
  }
}

TEST(Walker, ClimbsAndDescendsTheStairsOfTheDemo) {
  const auto demo = std::filesystem::path(BRUME_SOURCE_DIR) / "scenes/demo.toml";
  const Scenario scenario = load_scenario(demo, {}).value_or_throw();
  const BitGrid& grid = scenario.voxels.grid;
  Walker walker = at(grid, {6.15f, 0.2f, 1.2f});
  walk(walker, grid, vec3(0), 0.3);
  const float low = walker.feet_world().y;
  walk(walker, grid, vec3(0, 0, -1), 1.6);
  EXPECT_NEAR(walker.feet_world().y, low + 3, 1e-4) << "in the loft";
  for (int i = 0; i < 96; ++i) {
    walker.move(grid, {vec3(0, 0, 1), false, false}, 1.0 / 60);
    ASSERT_TRUE(walker.on_ground()) << i;
  }
  EXPECT_NEAR(walker.feet_world().y, low, 1e-4);
}

TEST(Walker, ClimbsNoHigherThanAStepAndFallsFromLedges) {
  BitGrid grid = space(0.0625f, vec3(8, 5, 3));
  fill(grid, {2, 0, 0}, {4, 0.5f, 3});
  fill(grid, {4, 0, 0}, {8, 1.125f, 3});  // 0.625 m more
  Walker walker = at(grid, {1, 0, 1.5f});
  walk(walker, grid, vec3(0), 0.1);
  walk(walker, grid, vec3(1, 0, 0), 3);
  EXPECT_NEAR(walker.feet_world().y, 0.5f, 2e-5);
  EXPECT_NEAR(walker.feet_world().x, 3.8f, 3e-5);
  // A jump reaches it. From there it falls.
  walker.move(grid, {vec3(1, 0, 0), false, true}, 1.0 / 60);
  EXPECT_FALSE(walker.on_ground());
  walk(walker, grid, vec3(1, 0, 0), 1);
  EXPECT_NEAR(walker.feet_world().y, 0.5f, 2e-5) << "0.6 m is too low a jump";
  WalkerOptions options;
  options.jump = 0.8f;
  walker.set_options(grid, options);
  walker.move(grid, {vec3(1, 0, 0), false, true}, 1.0 / 60);
  walk(walker, grid, vec3(1, 0, 0), 1);
  EXPECT_NEAR(walker.feet_world().y, 1.125f, 2e-5);
  bool was_in_air = false;
  while (walker.feet_world().x > 3) {
    walker.move(grid, {vec3(-1, 0, 0), false, false}, 1.0 / 60);
    was_in_air |= !walker.on_ground();
  }
  EXPECT_TRUE(was_in_air);
  walk(walker, grid, vec3(0), 1);
  EXPECT_NEAR(walker.feet_world().y, 0.5f, 2e-5);
}

TEST(Walker, StopsAtACeilingWithTheEyeBelowIt) {
  BitGrid grid = space(0.0625f, vec3(6, 4, 3));
  fill(grid, {0, 2, 0}, {3, 2.25f, 3});
  Walker walker = at(grid, {1, 0, 1.5f});
  walk(walker, grid, vec3(0), 0.1);
  float highest = 0;
  for (int i = 0; i < 60; ++i) {
    walker.move(grid, {vec3(0), false, i == 0}, 1.0 / 60);
    highest = std::max(highest, walker.feet_world().y);
  }
  EXPECT_NEAR(highest, 0.25f, 3e-5);
  // Half a metre down and under a lintel at the same time: the smoothed eye stays below it.
  BitGrid cellar = space(0.0625f, vec3(6, 4, 3));
  fill(cellar, {0, 0, 0}, {2, 0.5f, 3});
  fill(cellar, {2.5f, 1.8125f, 0}, {6, 2.5f, 3});
  Walker down = at(cellar, {1.5f, 0.5f, 1.5f});
  walk(down, cellar, vec3(0), 0.1);
  for (int i = 0; i < 30; ++i) {
    down.move(cellar, {vec3(1, 0, 0), true, false}, 1.0 / 60);
    ASSERT_FALSE(is_in_solid(cellar, down.eye_world())) << i;
  }
  EXPECT_GT(down.feet_world().x, 4);
}

TEST(Walker, PassesANarrowDoor) {
  BitGrid grid = space(0.25f, vec3(8, 4, 4));
  fill(grid, {4, 0, 0}, {4.25f, 3, 4});
  for (int z = 6; z < 9; ++z)  // 0.75 m wide, 2 m high
    for (int y = 0; y < 8; ++y) grid.set({16, y, z}, false);
  Walker walker = at(grid, {2, 0, 1.875f});
  walk(walker, grid, vec3(1, 0, 0), 2);
  EXPECT_GT(walker.feet_world().x, 5);
}

TEST(Walker, MovesOutOfSolidVoxels) {
  // A door of 0.25 m closes on it; it moves to the nearer side.
  BitGrid grid = space(0.125f, vec3(8, 4, 8));
  Walker walker = at(grid, {4.1f, 0, 4});
  walk(walker, grid, vec3(0), 0.1);
  fill(grid, {3.75f, 0, 0}, {4, 3, 8});
  walker.move(grid, {}, 0);
  EXPECT_FALSE(is_stuck(grid, body_of(walker)));
  EXPECT_NEAR(walker.feet_world().x, 4.2f, 3e-5);
  EXPECT_NEAR(walker.feet_world().z, 4, 1e-6);
  // Put into the ground, and into the middle of a mountain.
  walker.put(grid, {2, 0.5f, 2});
  EXPECT_NEAR(walker.feet_world().y, 0, 2e-5);
  BitGrid mountain = space(1, vec3(20, 20, 20));
  fill(mountain, vec3(0), vec3(20));
  walker.put(mountain, {10, 5, 10});
  EXPECT_NEAR(walker.feet_world().y, 20, 2e-5);
}

TEST(Walker, FliesThroughWallsAndLandsBesideThem) {
  BitGrid grid = space(0.25f, vec3(8, 4, 8));
  fill(grid, {3, 0, 0}, {4, 3, 8});
  Walker walker = at(grid, {1, 0, 4});
  walker.set_flying(grid, true);
  const vec3 eye = walker.eye_world();
  for (int i = 0; i < 60; ++i) walker.move(grid, {vec3(0.6f, 0.8f, 0), false, false}, 1.0 / 60);
  EXPECT_LT(glm::distance(walker.eye_world(), eye + 7.0f * vec3(0.6f, 0.8f, 0)), 1e-4f);
  for (int i = 0; i < 60; ++i) walker.move(grid, {vec3(0), true, false}, 1.0 / 60);
  EXPECT_LT(glm::distance(walker.eye_world(), eye + 7.0f * vec3(0.6f, 0.8f, 0)), 1e-4f) << "it hovers";
  walker.put(grid, {3.4f, 1.62f, 4});
  EXPECT_TRUE(is_stuck(grid, body_of(walker)));
  walker.set_flying(grid, false);
  EXPECT_FALSE(is_stuck(grid, body_of(walker)));
  EXPECT_NEAR(walker.feet_world().x, 2.8f, 3e-5);
}

/// Random boxes, walls and holes in a closed room.
BitGrid random_rooms(std::mt19937& random, float voxel) {
  BitGrid grid = space(voxel, vec3(24, 14, 18) * voxel, vec3(-3.3f, 0.7f, 2.1f));
  const ivec3 size = grid.size();
  const auto below = [&](int count) { return static_cast<int>(random() % static_cast<unsigned>(count)); };
  for (int i = 0; i < 30; ++i) {
    const ivec3 low(below(size.x), below(size.y), below(size.z));
    const ivec3 high = low + ivec3(1 + below(6), 1 + below(4), 1 + below(6));
    for_each_in(intersection<int>({low, high}, {ivec3(0), size}), [&](ivec3 v) { grid.set(v, i % 4 != 3); });
  }
  for_each_in({ivec3(0), size}, [&](ivec3 v) {
    if (glm::any(glm::equal(v, ivec3(0))) || glm::any(glm::equal(v, size - 1))) grid.set(v, true);
  });
  return grid;
}

TEST(Walker, NeverEntersSolidVoxelsOrPassesWalls) {
  std::mt19937 random(1);
  const auto real = [&](float low, float high) {
    return low + (high - low) * static_cast<float>(random() % 4096) / 4095.0f;
  };
  int moved = 0;
  for (unsigned world = 0; world < 60; ++world) {
    // Covers body sizes from a twentieth of a voxel to many voxels.
    const float voxel = std::array{0.015625f, 0.0625f, 0.25f, 0.5f, 2.0f, 10.0f}[world % 6];
    const float scale = voxel < 0.25f ? 4 * voxel : 1.0f;  // a smaller body for small voxels
    WalkerOptions options{0.2f * scale, 1.75f * scale, 1.62f * scale, 0.55f * scale};
    options.walk_speed = world % 3 == 0 ? 300.0f : 3.5f;
    options.jump = 2 * scale;
    BitGrid grid = random_rooms(random, voxel);
    const vec3 low = grid.layout().origin_world, high = low + vec3(grid.size()) * voxel;
    Walker walker = at(grid, 0.5f * (low + high), options);
    // A body that does not fit into the room ends up on top of it.
    const bool inside = walker.feet_world().y < high.y - voxel;
    vec3 direction(0);
    for (int i = 0; i < 400; ++i) {
      if (i % 8 == 0) direction = {real(-1, 1), real(-1, 1), real(-1, 1)};
      const vec3 before = walker.feet_world();
      walker.move(grid, {direction, i % 5 == 0, i % 16 == 0}, i % 10 == 0 ? real(0, 3) : real(0, 0.05f));
      moved += walker.feet_world() != before;
      ASSERT_FALSE(is_stuck(grid, body_of(walker))) << "world " << world << ", move " << i;
      ASSERT_FALSE(is_in_solid(grid, walker.eye_world())) << "world " << world << ", move " << i;
      if (inside) {
        ASSERT_TRUE(glm::all(glm::greaterThan(walker.feet_world(), low)));
        ASSERT_TRUE(glm::all(glm::lessThan(walker.feet_world(), high)));
      }
      ASSERT_GE(walker.feet_world().y, low.y);
      if (i % 100 == 99) {  // something becomes solid around it
        const ivec3 v(glm::floor(voxel_from_world(grid.layout(), walker.feet_world())));
        if (!inside || voxel > 0.5f) continue;
        const ivec3 stay = grid.size() - 1;
        if (glm::all(glm::greaterThan(v, ivec3(0))) && glm::all(glm::lessThan(v, stay))) grid.set(v, true);
        walker.move(grid, {}, 0);
        ASSERT_FALSE(is_stuck(grid, body_of(walker))) << "world " << world << ", move " << i;
        if (walker.feet_world().y > high.y - voxel) break;
      }
    }
  }
  EXPECT_GT(moved, 60 * 100);
}

TEST(Walker, MotionIsReproducible) {
  std::mt19937 random(4);
  const BitGrid grid = random_rooms(random, 0.5f);
  std::set<std::array<float, 3>> ends;
  for (int times = 0; times < 2; ++times) {
    Walker walker = at(grid, {3, 3, 6});
    std::mt19937 inputs(9);
    for (int i = 0; i < 500; ++i) {
      const auto angle = static_cast<float>(inputs() % 628) / 100;
      walker.move(grid, {{std::cos(angle), 0, std::sin(angle)}, false, inputs() % 9 == 0},
                  0.001 * static_cast<double>(inputs() % 50));
    }
    ends.insert({walker.eye_world().x, walker.eye_world().y, walker.eye_world().z});
  }
  EXPECT_EQ(ends.size(), 1u);
}

TEST(Walker, IgnoresNan) {
  const BitGrid grid = space(0.25f, vec3(8, 4, 8));
  Walker walker = at(grid, {4, 0, 4});
  walk(walker, grid, vec3(0), 0.5);
  const vec3 eye = walker.eye_world();
  walker.move(grid, {vec3(NAN, 0, 1), false, false}, 0.5);
  walker.move(grid, {vec3(1, 0, 0), false, false}, NAN);
  walker.move(grid, {vec3(1, 0, 0), false, false}, -1);
  EXPECT_EQ(walker.eye_world(), eye);
  walker.put(grid, {NAN, INFINITY, 2});
  EXPECT_FALSE(is_stuck(grid, body_of(walker)));
}

double real_within(std::mt19937& random, double low, double high) {
  return low + (high - low) * static_cast<double>(random()) / 4294967296.0;
}

TEST(BodySweep, MatchesTestingEveryVoxelAlongThePath) {
  std::mt19937 random(2);
  const auto real = [&](double low, double high) { return real_within(random, low, high); };
  int blocked = 0;
  for (int i = 0; i < 4000; ++i) {
    static BitGrid grid = random_rooms(random, 0.5f);
    if (i % 400 == 0) grid = random_rooms(random, 0.5f);
    const dvec3 low(real(-4, 9), real(0.7, 7), real(1, 11));
    const Body body{low, low + dvec3(real(0.05, 2), real(0.05, 2), real(0.05, 2))};
    if (is_stuck(grid, body)) continue;
    const int axis = static_cast<int>(random() % 3);
    const double displacement = real(-6, 6), done = sweep(grid, body, axis, displacement);
    ASSERT_LE(std::abs(done), std::abs(displacement));
    ASSERT_GE(done * displacement, 0);
    // The path is free, and if it ends early there is a solid voxel just beyond its end.
    dvec3 to(0);
    for (double share = 0; share <= 1; share += 0.01) {
      to[axis] = done * share;
      ASSERT_FALSE(is_stuck(grid, body.moved(to))) << i;
    }
    if (done == displacement) continue;
    ++blocked;
    to[axis] = done + (displacement > 0 ? 2 : -2) * kSkin;
    ASSERT_TRUE(is_stuck(grid, body.moved(to))) << i;
  }
  EXPECT_GT(blocked, 300);
}

TEST(BodySweep, FindsTheShortestWayOutOfSolidVoxels) {
  std::mt19937 random(3);
  const auto real = [&](double low, double high) { return real_within(random, low, high); };
  int stuck = 0;
  for (int i = 0; i < 40; ++i) {
    const BitGrid grid = random_rooms(random, 0.5f);
    const dvec3 low(real(-3, 7), real(1, 6), real(3, 9));
    const Body body{low, low + dvec3(0.4, 1.2, 0.4)};
    if (!is_stuck(grid, body)) continue;
    ++stuck;
    const dvec3 offset = offset_to_free_space(grid, body);
    EXPECT_FALSE(is_stuck(grid, body.moved(offset)));
    // No nearer point of a fine lattice is free.
    const double length = glm::length(offset) - 1e-4, step = 0.06;
    const int n = static_cast<int>(std::min(length, 3.0) / step);
    for (int z = -n; z <= n; ++z)
      for (int y = -n; y <= n; ++y)
        for (int x = -n; x <= n; ++x) {
          const dvec3 other = step * dvec3(x, y, z);
          EXPECT_TRUE(glm::length(other) >= length || is_stuck(grid, body.moved(other)));
        }
  }
  EXPECT_GT(stuck, 10);
}

}  // namespace
}  // namespace brume::scenario
