#include "sim/world.hpp"

#include "smoke/holes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "tests/sanitized.hpp"

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
  return {tick, from, at, {voxels, 64, 1152, 192}};
}

TEST(Landing, IsTheFreeVoxelBeforeTheFirstSolidOne) {
  const BitGrid grid = make_house();
  // From x = 1 m towards the wall at voxel 20; `at` lies before, in and behind it.
  for (const double x : {3.0, 7.2, 15.0}) {
    const auto landing = landing_voxel(grid, glm::vec3(1, 1.2f, 5.2f), glm::vec3(x, 1.2f, 5.2f));
    EXPECT_EQ(landing, glm::ivec3(19, 2, 6));
  }
}

TEST(Landing, IsTheTargetIfThePathIsFree) {
  const BitGrid grid = make_house();
  EXPECT_EQ(landing_voxel(grid, glm::vec3(8, 1, 4), glm::vec3(9.1f, 3.1f, 6.1f)), glm::ivec3(24, 6, 8));
  // Aimed at a point outside: the last voxel along the path.
  EXPECT_EQ(landing_voxel(grid, glm::vec3(8, 1.2f, 4.2f), glm::vec3(90, 1.2f, 4.2f)), glm::ivec3(39, 2, 4));
  // A ray that misses the grid.
  EXPECT_EQ(landing_voxel(grid, glm::vec3(-9, 1, 4), glm::vec3(-9, 1, 8)), std::nullopt);
  // Without a flight it is that place.
  EXPECT_EQ(landing_voxel(grid, glm::vec3(8.1f, 1.2f, 4.2f), glm::vec3(8.1f, 1.2f, 4.2f)),
            glm::ivec3(22, 2, 4));
}

TEST(Landing, FromASolidVoxelFindsTheNextFreeOne) {
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
  const VoxelRuler ruler(grid.layout());
  std::mt19937 random(1);
  std::uniform_int_distribution<int> coordinate(-8000, 16000);
  for (int i = 0; i < 2000; ++i) {
    Position from(coordinate(random), coordinate(random), coordinate(random));
    Position to(coordinate(random), coordinate(random), coordinate(random));
    if (i % 3 == 0) to[i % 2] = from[i % 2];
    const glm::dvec3 start = glm::dvec3(ruler.subvoxel(from)) / 1024.0;
    const glm::dvec3 ray = glm::dvec3(ruler.subvoxel(to)) / 1024.0 - start;
    glm::ivec3 last(0);
    double entry = 0;
    int steps = 0;
    walk_ray(grid, ruler, from, to, [&](const WalkStep& step) {
      EXPECT_TRUE(grid.contains(step.voxel));
      const double exit = static_cast<double>(step.exit.num) / static_cast<double>(step.exit.den);
      // Between entry and exit the ray is in this voxel.
      if (steps > 0) {
        const glm::dvec3 middle = start + ray * ((entry + exit) / 2);
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

TEST(Walk, PointsOutOfRangeAndNanAreInvalidPositions) {
  const double infinity = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  constexpr int kOutside = kMaxCoordinate + 1;
  EXPECT_EQ(metres(infinity, -infinity, nan), Position(kOutside, -kOutside, kOutside));
  EXPECT_EQ(metres(1e300, 0.5, -1e300), Position(kOutside, 512, -kOutside));
  EXPECT_EQ(metres(16384, -16384, 0), Position(kMaxCoordinate, -kMaxCoordinate, 0));
  const BitGrid grid = make_house();
  World world(grid);
  for (const double wrong : {nan, infinity, -infinity, 16384.1, -1e300}) {
    EXPECT_FALSE(world.append(throw_at(0, metres(wrong, 1, 5), metres(7, 1, 5))));
    EXPECT_FALSE(world.append(Shot{0, metres(0, wrong, 5), metres(7, 1, 5)}));
    EXPECT_FALSE(world.append(Blast{0, metres(0, 1, wrong)}));
    EXPECT_FALSE(world.append(MoveBody{0, 1, metres(wrong, wrong, wrong)}));
  }
  EXPECT_TRUE(world.log().empty());
  // The landing position can be queried for any point.
  static_cast<void>(
      landing_voxel(grid, glm::vec3(std::numeric_limits<float>::quiet_NaN()), glm::vec3(1e30f)));
}

TEST(World, RejectsEventsOutOfRange) {
  const BitGrid grid = make_house();
  World world(grid);
  const std::uint64_t before = world.state_hash();
  const auto refused = [&](const Event& event) {
    const auto result = world.append(event);
    return !result && result.failure().code == ErrorCode::bad_input && !result.failure().message.empty();
  };
  EXPECT_TRUE(refused(throw_at(0, {kMaxCoordinate + 1, 0, 0}, {0, 0, 0})));
  EXPECT_TRUE(refused(throw_at(0, {0, std::numeric_limits<int>::min(), 0}, {0, 0, 0})));
  EXPECT_TRUE(refused(throw_at(kMaxTick + 1, {0, 0, 0}, {1, 0, 0})));
  EXPECT_TRUE(refused(throw_at(0, {0, 0, 0}, {1, 0, 0}, 0)));
  EXPECT_TRUE(refused(throw_at(0, {0, 0, 0}, {1, 0, 0}, kMaxFillVoxels + 1)));
  EXPECT_TRUE(refused(ThrowSmoke{0, {0, 0, 0}, {1, 0, 0}, {100, 0, 0, 1}}));
  EXPECT_TRUE(refused(ThrowSmoke{0, {0, 0, 0}, {1, 0, 0}, {100, 1, kMaxTick + 1, 1}}));
  EXPECT_TRUE(refused(ThrowSmoke{0, {0, 0, 0}, {1, 0, 0}, {100, 1, 0, 0}}));
  EXPECT_TRUE(refused(Shot{0, {5, 5, 5}, {5, 5, 5}}));
  EXPECT_TRUE(refused(Shot{0, {5, 5, 5}, {5, 5, 6}, 0}));
  EXPECT_TRUE(refused(Shot{0, {5, 5, 5}, {5, 5, 6}, 10, {250, 50, kMaxMilliseconds + 1, 350}}));
  EXPECT_TRUE(refused(Shot{0, {5, 5, 5}, {5, 5, 6}, 10, {}, HoleShape::box, 0, kFullTurn}));
  EXPECT_TRUE(refused(Shot{0, {5, 5, 5}, {5, 5, 6}, 10, {}, HoleShape::mask}));
  EXPECT_TRUE(refused(Blast{0, {0, 0, 0}, 0}));
  EXPECT_TRUE(refused(Blast{0, {0, 0, 0}, 512 * (kMaxBlastVoxels + 1)}));
  EXPECT_TRUE(refused(Blast{0, {0, 0, 0}, 1024, 1023}));
  EXPECT_TRUE(refused(Blast{0, {0, 0, 0}, 1024, 1024, 256}));
  EXPECT_TRUE(refused(Blast{0, {0, 0, 0}, 1024, 1024, 5, 500, 499}));
  EXPECT_TRUE(refused(MoveBody{0, 1, {0, 0, -kMaxCoordinate - 1}}));
  EXPECT_TRUE(refused(LevelEdit{0, {{{99, 0, 0}, 1, 0}}}));
  EXPECT_TRUE(refused(LevelEdit{0, {{{1, 0, 0}, 1, 1}}}));
  EXPECT_TRUE(refused(LevelEdit{0, {{{1, 0, 0}, 1, 0}, {{0, 0, 0}, 1, 0}}}));
  EXPECT_TRUE(world.log().empty());
  EXPECT_EQ(world.state_hash(), before);
  EXPECT_THROW(World(grid, {0}), Error);
  EXPECT_THROW(World(BitGrid({{3, 3, 3}, 0.5f, glm::vec3(1e9f)})), Error);
}

TEST(World, GrenadeFliesAt20MetresPerSecondAndDetonates) {
  const BitGrid grid = make_house();
  World world(grid);
  const Position from = metres(-2, 1.25, 5.25);
  world.append(throw_at(10, from, metres(7, 1.25, 5.25))).value_or_throw();
  world.advance_to(9);
  EXPECT_TRUE(world.state().flights.empty());
  // Lands in voxel 19: its centre is at x = 6.75 m, 8.75 m away: 28 ticks of 1/64 s.
  for (std::uint32_t tick = 10; tick < 38; ++tick) {
    world.advance_to(tick);
    ASSERT_EQ(world.state().flights.size(), 1u);
    EXPECT_EQ(world.state().flights[0].detonation_tick, 38u);
    const auto grenades = grenades_of(world.state());
    ASSERT_EQ(grenades.size(), 1u);
    EXPECT_NEAR(grenades[0].position_world.x, -2 + 20.0 * (tick - 10) / 64, 0.01);
    EXPECT_TRUE(world.state().clouds.empty());
  }
  world.advance_to(38);
  EXPECT_TRUE(world.state().flights.empty());
  EXPECT_EQ(world.state().clouds.size(), 1u);
}

/// Several smokes, many shots, blasts, moves and a door.
std::vector<Event> busy_log(const BitGrid& grid) {
  std::vector<Event> events;
  std::mt19937 random(11);
  std::uniform_real_distribution<double> x(-2, 16), y(0.3, 4.5), z(3, 21);
  const auto anywhere = [&] {
    const double at_x = x(random), at_y = y(random);
    return metres(at_x, at_y, z(random));
  };
  for (std::uint32_t i = 0; i < 8; ++i) {
    ThrowSmoke smoke = throw_at(i * 20, anywhere(), anywhere(), 400 + 200 * i);
    if (i % 2 == 0) smoke.smoke.hold_ticks = 40;
    events.emplace_back(smoke);
  }
  for (std::uint32_t i = 0; i < 60; ++i) events.emplace_back(Shot{40 + 5 * i, anywhere(), anywhere()});
  for (std::uint32_t i = 0; i < 4; ++i) events.emplace_back(Blast{60 + 70 * i, anywhere()});
  for (std::uint32_t i = 0; i < 90; ++i) events.emplace_back(MoveBody{5 * i, i % 3, anywhere()});
  for (std::uint32_t i = 0; i < 5; ++i)
    events.emplace_back(
        LevelEdit{30 + 80 * i, edit_box(grid.layout(), {20, 0, 18}, {21, 5, 21}, i % 2 == 0)});
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return tick_of(a) < tick_of(b); });
  return events;
}

constexpr std::uint32_t kBusyTicks = 500;

class BusyWorld : public testing::Test {
 protected:
  BusyWorld() : grid_(make_house()), events_(busy_log(grid_)), world_(grid_) {
    fill(world_, 0);
    for (std::uint32_t tick = 0; tick < kBusyTicks; ++tick) {
      world_.advance_to(tick);
      hashes_.push_back(world_.state_hash());
      states_.push_back(world_.state());
    }
  }
  void fill(World& world, std::uint32_t from_tick) const {
    for (const Event& event : events_)
      if (tick_of(event) >= from_tick) world.append(event).value_or_throw();
  }

  BitGrid grid_;
  std::vector<Event> events_;
  World world_;
  std::vector<std::uint64_t> hashes_;
  std::vector<State> states_;
};

TEST_F(BusyWorld, EveryTickDiffersFromTheOneBefore) {
  for (std::size_t i = 1; i < hashes_.size(); ++i) EXPECT_NE(hashes_[i], hashes_[i - 1]);
}

TEST_F(BusyWorld, RollsBackSixtyTicksAndReplaysTheSame) {
  for (std::uint32_t tick = 60; tick < kBusyTicks; tick += 7) {
    world_.advance_to(tick);
    for (std::uint32_t again = tick - 60; again <= tick; ++again) {
      world_.advance_to(again);
      ASSERT_EQ(world_.state_hash(), hashes_[again]) << "tick " << again << " of " << tick;
    }
  }
}

TEST_F(BusyWorld, ContinuesIdenticallyFromAThousandSnapshots) {
  std::mt19937 random(2);
  for (int i = 0; i < (kSanitized ? 200 : 1000); ++i) {
    const auto from = static_cast<std::uint32_t>(random() % kBusyTicks);
    const auto to = std::min(from + static_cast<std::uint32_t>(random() % 40), kBusyTicks - 1);
    World other(grid_);
    other.restore(states_[from]).value_or_throw();
    ASSERT_EQ(other.state_hash(), hashes_[from]);
    EXPECT_EQ(other.earliest_tick(), from);
    for (const Event& event : events_)
      if (tick_of(event) > from && tick_of(event) <= to) other.append(event).value_or_throw();
    other.advance_to(to);
    ASSERT_EQ(other.state_hash(), hashes_[to]) << from << " to " << to;
  }
}

TEST_F(BusyWorld, RestoringDoesNotDependOnThePreviousState) {
  for (const std::uint32_t tick : {450u, 0u, 200u, 33u, 499u}) {
    World other(grid_);
    other.restore(states_[450]).value_or_throw();
    other.restore(states_[tick]).value_or_throw();
    fill(other, tick + 1);
    other.advance_to(kBusyTicks - 1);
    EXPECT_EQ(other.state_hash(), hashes_.back());
    EXPECT_FALSE(other.append(MoveBody{tick, 1, {0, 0, 0}})) << "of a tick that the state has taken in";
  }
  EXPECT_FALSE(World(grid_, {32}).restore(states_[5]));
  const BitGrid small({{3, 3, 3}, 0.5f, glm::vec3(0)});
  EXPECT_FALSE(World(small).restore(states_[5]));
}

TEST_F(BusyWorld, DroppingHistoryDoesNotChangeTheState) {
  world_.forget_before(300);
  EXPECT_EQ(world_.state_hash(), hashes_.back());
  EXPECT_EQ(world_.earliest_tick(), 300u);
  // Events occur every few ticks, and a snapshot is stored every 64.
  EXPECT_TRUE(std::all_of(world_.log().begin(), world_.log().end(),
                          [&](const Event& event) { return tick_of(event) > 300u - 128; }));
  world_.advance_to(310);
  EXPECT_EQ(world_.state_hash(), hashes_[310]);
  world_.advance_to(5);
  EXPECT_EQ(world_.tick(), 300u);
  EXPECT_EQ(world_.state_hash(), hashes_[300]);
  EXPECT_FALSE(world_.append(MoveBody{299, 1, {0, 0, 0}}));
  EXPECT_EQ(world_.state_hash(), hashes_[300]);
}

// Whatever has happened before, and whichever snapshots there are.
TEST_F(BusyWorld, TheLimitOfLateEventsIsExact) {
  std::mt19937 random(11);
  for (int i = 0; i < 60; ++i) {
    World world(grid_);
    fill(world, i % 3 == 0 ? kBusyTicks : 0);
    const auto present = static_cast<std::uint32_t>(random() % (kBusyTicks - 1));
    world.advance_to(present);
    std::uint32_t limit = 0;
    for (int k = 0; k < 3; ++k) {
      const auto tick = static_cast<std::uint32_t>(random() % (present + 10));
      world.forget_before(tick);
      limit = std::max(limit, tick);
      ASSERT_EQ(world.first_open_tick(), limit);
      ASSERT_EQ(world.earliest_tick(), std::min(limit, present));
    }
    const std::uint64_t hash = world.state_hash();
    if (limit > 0) {
      EXPECT_FALSE(world.append(MoveBody{limit - 1, 99, {0, 0, 0}})) << limit;
      EXPECT_FALSE(world.append(MoveBody{0, 99, {0, 0, 0}})) << limit;
      EXPECT_FALSE(world.replace_from(limit - 1, {})) << limit;
    }
    ASSERT_EQ(world.state_hash(), hash);

    // At the limit, an event has the effect that it has without a limit.
    World unlimited(grid_);
    fill(unlimited, i % 3 == 0 ? kBusyTicks : 0);
    for (World* one : {&world, &unlimited}) {
      ASSERT_TRUE(one->append(MoveBody{limit, 99, {5, 6, 7}})) << limit;
      one->advance_to(kBusyTicks - 1);
    }
    ASSERT_EQ(world.state_hash(), unlimited.state_hash()) << limit << " at " << present;
  }
}

TEST(World, LateEventsOfAQuietMatchAreRefused) {
  const BitGrid grid = make_house();
  World world(grid);
  for (std::uint32_t tick = 0; tick < 64 * 60; ++tick) {
    world.advance_to(tick);
    if (tick > 64) world.forget_before(tick - 64);
  }
  const auto refused = world.append(MoveBody{64 * 60 - 66, 1, {0, 0, 0}});
  EXPECT_EQ(refused.failure().message,
            "event at tick 3774: expected tick 3775 or later; earlier history was dropped");
  EXPECT_TRUE(world.append(MoveBody{64 * 60 - 65, 1, {0, 0, 0}}));
  EXPECT_EQ(world.state().events, 1u);
}

TEST_F(BusyWorld, TakesLateEventsWhenEveryTickIsDropped) {
  World server(grid_);
  auto event = events_.begin();
  for (std::uint32_t tick = 0; tick < kBusyTicks; ++tick) {
    server.advance_to(tick);
    if (tick > 50) server.forget_before(tick - 50);
    // Received 20 ticks late.
    for (; event != events_.end() && tick_of(*event) + 20 <= tick; ++event)
      server.append(*event).value_or_throw();
  }
  for (; event != events_.end(); ++event) server.append(*event).value_or_throw();
  EXPECT_EQ(server.state_hash(), hashes_.back());
}

TEST_F(BusyWorld, AcceptsLateEventsInAnyOrder) {
  std::mt19937 random(5);
  std::vector<std::vector<Event>> by_tick;
  for (const Event& event : events_) {
    if (by_tick.empty() || tick_of(by_tick.back().front()) != tick_of(event)) by_tick.emplace_back();
    by_tick.back().push_back(event);
  }
  for (int i = 0; i < (kSanitized ? 2 : 3); ++i) {
    std::shuffle(by_tick.begin(), by_tick.end(), random);
    World late(grid_);
    late.advance_to(i == 0 ? kBusyTicks - 1 : static_cast<std::uint32_t>(random() % kBusyTicks));
    for (const auto& events : by_tick)
      for (const Event& event : events) late.append(event).value_or_throw();
    for (const std::uint32_t tick : {100u, 250u, kBusyTicks - 1}) {
      late.advance_to(tick);
      EXPECT_EQ(late.state_hash(), hashes_[tick]);
    }
  }
}

TEST_F(BusyWorld, AcceptsEventsOfTheCurrentTick) {
  World heard(grid_);
  auto event = events_.begin();
  for (std::uint32_t tick = 0; tick < kBusyTicks; ++tick) {
    heard.advance_to(tick);
    for (; event != events_.end() && tick_of(*event) == tick; ++event) heard.append(*event).value_or_throw();
    ASSERT_EQ(heard.state_hash(), hashes_[tick]) << tick;
  }
}

TEST_F(BusyWorld, AcceptsAFutureEventAfterRollback) {
  // Snapshots of later ticks do not have it.
  const auto late = std::find_if(events_.begin(), events_.end(), [](const Event& e) {
    return std::holds_alternative<Blast>(e);  // tick 60
  });
  std::vector<Event> others = events_;
  others.erase(others.begin() + (late - events_.begin()));
  World world(grid_);
  world.append(others).value_or_throw();
  world.advance_to(kBusyTicks - 1);
  world.advance_to(10);
  world.append(*late).value_or_throw();
  World told(grid_);
  told.append(others).value_or_throw();
  told.append(*late).value_or_throw();
  for (const std::uint32_t tick : {70u, kBusyTicks - 1, 150u}) {
    world.advance_to(tick);
    told.advance_to(tick);
    EXPECT_EQ(world.state_hash(), told.state_hash()) << tick;
  }
}

TEST_F(BusyWorld, ReplacesTheEventsFromATickOn) {
  std::mt19937 random(7);
  World world(grid_);
  world.append(events_).value_or_throw();
  for (int i = 0; i < (kSanitized ? 8 : 30); ++i) {
    const auto from = static_cast<std::uint32_t>(random() % kBusyTicks);
    std::vector<Event> tail;
    for (const Event& event : events_)
      if (tick_of(event) >= from && random() % 3 != 0) tail.push_back(event);
    World told(grid_);
    for (const Event& event : world.log())
      if (tick_of(event) < from) told.append(event).value_or_throw();
    told.append(tail).value_or_throw();
    world.advance_to(static_cast<std::uint32_t>(random() % kBusyTicks));
    const std::uint32_t tick = world.tick();
    world.replace_from(from, tail).value_or_throw();
    EXPECT_EQ(world.tick(), tick);
    EXPECT_TRUE(std::equal(world.log().begin(), world.log().end(), told.log().begin(), told.log().end()));
    for (const std::uint32_t at : {tick, from, static_cast<std::uint32_t>(random() % kBusyTicks)}) {
      world.advance_to(at);
      told.advance_to(at);
      ASSERT_EQ(world.state_hash(), told.state_hash()) << i << ", tick " << at;
    }
    // And the original events again.
    std::vector<Event> all;
    for (const Event& event : events_)
      if (tick_of(event) >= from) all.push_back(event);
    if (i % 2 == 0) world.replace_from(from, all).value_or_throw();
  }
  const std::uint64_t hash = world.state_hash();
  const auto refused = world.replace_from(30, {Shot{29, {0, 0, 0}, {5, 5, 5}}});
  EXPECT_EQ(refused.failure().message, "event at tick 29: expected tick 30 or later");
  EXPECT_FALSE(world.replace_from(30, {Shot{30, {5, 5, 5}, {5, 5, 5}}}));
  EXPECT_EQ(world.state_hash(), hash);
}

TEST_F(BusyWorld, ChangingMasksEqualsStartingWithThem) {
  const sim::MaskKey few{2, 17}, many{5, 99};
  Shot shot{90, metres(1, 1, 4), metres(9, 1.5, 8)};
  shot.shape = HoleShape::mask;
  shot.mask = 1;
  World world(grid_, {.masks = few}), told(grid_, {.masks = many});
  for (World* one : {&world, &told}) one->append(events_).value_or_throw();
  for (World* one : {&world, &told}) one->append(shot).value_or_throw();
  world.advance_to(400);
  shot.tick = 300;
  shot.mask = 4;
  const std::uint64_t hash = world.state_hash();
  EXPECT_FALSE(world.append(shot));
  EXPECT_FALSE(world.replace_from(300, {shot}, sim::MaskKey{1, 3})) << "the first shot has mask 1";
  EXPECT_EQ(world.state_hash(), hash);
  EXPECT_EQ(world.settings().masks, few);
  world.replace_from(300, {shot}, many).value_or_throw();
  told.replace_from(300, {shot}).value_or_throw();
  for (const std::uint32_t tick : {400u, 299u, 100u, 64u, 10u, 350u}) {
    world.advance_to(tick);
    told.advance_to(tick);
    EXPECT_EQ(world.state_hash(), told.state_hash()) << tick;
  }
}

TEST_F(BusyWorld, AppendsAllEventsOrNone) {
  World told(grid_);
  told.advance_to(kBusyTicks - 1);
  std::vector<Event> wrong = events_;
  wrong.push_back(Shot{1, {5, 5, 5}, {5, 5, 5}});
  EXPECT_FALSE(told.append(wrong));
  EXPECT_TRUE(told.log().empty());
  told.append(events_).value_or_throw();
  EXPECT_EQ(told.state_hash(), hashes_.back());
}

TEST(World, HoleReachesThroughTheSmokeToTheWallAndCloses) {
  const BitGrid grid = make_house();
  World world(grid);
  world.append(throw_at(0, metres(0, 1.2, 5.2), metres(7, 1.2, 5.2), 3000)).value_or_throw();
  // Along +x at z = 5.2 m: the wall's voxel 20 is x = 7 to 7.5 m; the hole ends in its middle.
  const Shot shot{200, metres(-2, 1.2, 5.2), metres(0, 1.2, 5.2)};
  world.append(shot).value_or_throw();
  world.advance_to(199);
  EXPECT_TRUE(world.state().holes.empty());
  world.advance_to(200);
  ASSERT_EQ(world.state().holes.size(), 1u);
  const shared::Hole hole = smoke::make_holes(world.state())[0];
  EXPECT_NEAR(hole.distance_to_far, 9.25, 0.01);
  EXPECT_NEAR(hole.forward.x, 1, 1e-6);
  EXPECT_NEAR(glm::dot(hole.forward, hole.right), 0, 1e-6);
  EXPECT_NEAR(glm::dot(glm::cross(hole.right, hole.forward), hole.up), 1, 1e-6);
  EXPECT_FLOAT_EQ(hole.time_start, 200.0f / 64);
  // It never has an effect behind the wall.
  for (int i = 0; i < 200; ++i)
    EXPECT_EQ(hole_strength(hole, {7.6f, 1.2f, 5.2f}, 200.0f / 64 + 0.01f * static_cast<float>(i), 0.0f), 0);
  EXPECT_GT(hole_strength(hole, {6.9f, 1.2f, 5.2f}, 200.0f / 64 + 0.5f, 0.0f), 0.9f);
  // 250 + 50 + 1000 + 350 ms are 105.6 ticks.
  world.advance_to(305);
  EXPECT_EQ(world.state().holes.size(), 1u);
  world.advance_to(306);
  EXPECT_TRUE(world.state().holes.empty());
}

TEST(World, StateDependsOnTheMasks) {
  const BitGrid grid = make_house();
  World world(grid, {.masks = {2, 77}});
  EXPECT_TRUE(world.append(Shot{0, {5, 5, 5}, {5, 5, 6}, 10, {}, HoleShape::mask, 1}));
  const auto refused = world.append(Shot{3, {5, 5, 5}, {5, 5, 6}, 10, {}, HoleShape::mask, 2});
  EXPECT_EQ(refused.failure().message, "shot at tick 3: mask 2 in a world with 2; set WorldSettings::masks");
  World same(grid, {.masks = {2, 77}}), other(grid, {.masks = {2, 78}});
  EXPECT_TRUE(same.restore(world.state()));
  const auto mismatch = other.restore(world.state());
  EXPECT_EQ(mismatch.failure().message,
            "the state is of a world with other masks than this world's; load the same");
  EXPECT_NE(other.state_hash(), World(grid, {.masks = {2, 77}}).state_hash());
}

TEST(World, StateDependsOnTheLevel) {
  const BitGrid grid = make_house();
  World world(grid, {.level_hash = 5});
  World same(grid, {.level_hash = 5}), other(grid, {.level_hash = 6});
  EXPECT_EQ(world.state_hash(), same.state_hash());
  EXPECT_NE(world.state_hash(), other.state_hash());
  EXPECT_NE(world.state_hash(), World(grid).state_hash());
  world.advance_to(3);
  EXPECT_TRUE(same.restore(world.state()));
  const auto mismatch = other.restore(world.state());
  EXPECT_EQ(mismatch.failure().message,
            "the state is of another level than this world's; load the same triangles or voxels, in the same "
            "order");
  EXPECT_EQ(other.tick(), 0u);
}

TEST(World, ShotThatMissesTheSmokeLeavesNoHole) {
  const BitGrid grid = make_house();
  World world(grid);
  world.append(Shot{0, metres(-2, 1.2, 5.2), metres(0, 1.2, 5.2)}).value_or_throw();  // no smoke yet
  world.append(throw_at(1, metres(0, 1.2, 5.2), metres(7, 1.2, 5.2), 100)).value_or_throw();
  world.append(Shot{90, metres(-2, 4, 20), metres(0, 4, 20)}).value_or_throw();  // far from it
  // Behind the wall, towards it, and away from it: the smoke is on the other side.
  world.append(Shot{90, metres(16, 1.2, 20), metres(12, 1.2, 20)}).value_or_throw();
  world.append(Shot{90, metres(16, 1.2, 5.2), metres(16.5, 1.2, 5.2)}).value_or_throw();
  world.advance_to(95);
  EXPECT_TRUE(world.state().holes.empty());
  world.advance_to(10);
  EXPECT_TRUE(world.state().holes.empty());
}

TEST(World, BodiesRecordTheirPositions) {
  const BitGrid grid = make_house();
  World world(grid);
  world.append(MoveBody{3, 7, {1, 2, 3}}).value_or_throw();
  world.append(MoveBody{8, 7, {4, 5, 6}}).value_or_throw();
  world.append(MoveBody{8, 2, {9, 9, 9}}).value_or_throw();
  world.advance_to(8);
  ASSERT_EQ(world.state().bodies.size(), 2u);
  EXPECT_EQ(world.state().bodies[0], (Body{2, {9, 9, 9}, {9, 9, 9}, 8, 8}));
  EXPECT_EQ(world.state().bodies[1], (Body{7, {4, 5, 6}, {1, 2, 3}, 8, 3}));
}

}  // namespace
}  // namespace brume::sim
