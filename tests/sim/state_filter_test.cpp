#include "sim/state_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "sim/world.hpp"
#include "tests/sim/random_events.hpp"

namespace brume::sim {
namespace {

/// A busy match in a box with a wall across it.
class StateFilterTest : public testing::Test {
 protected:
  static constexpr std::uint32_t kTicks = 300;

  static voxel::BitGrid level() {
    voxel::BitGrid grid({{41, 13, 33}, 0.5f, {-10, -1, -8}});
    apply_edits(grid, edit_box(grid.layout(), {0, 0, 0}, {41, 1, 33}, true));
    apply_edits(grid, edit_box(grid.layout(), {20, 0, 0}, {21, 13, 30}, true));
    return grid;
  }
  State state_at(std::uint32_t tick) {
    world_.advance_to(tick);
    return world_.state();
  }
  Box<int> random_box() {
    const auto below = [&](int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); };
    Box<int> box;
    for (int axis = 0; axis < 3; ++axis) {
      const int size = level_.size()[axis];
      box.low[axis] = below(size + 20) - 10;
      box.high[axis] = box.low[axis] + 1 + below(9);
    }
    return box;
  }

  std::mt19937 random_{5};
  const voxel::BitGrid level_ = level();
  World world_ = [this] {
    World world(level_, {});
    for (const Event& event : random_events(3, level_.layout(), 60, kTicks)) (void)world.append(event);
    EventDrawing draw{random_, level_.layout()};
    for (int i = 0; i < 200; ++i) {
      Shot shot{draw.below(kTicks)};
      draw({}, shot.origin);
      draw({}, shot.toward);
      (void)world.append(shot);
    }
    return world;
  }();
};

/// The voxels that matter to a box, larger by what is around them.
Box<int> grown(const Box<int>& box, int by = kFilterReach) {
  return {box.low - by, box.high + by};
}

/// Items by key, whether a list of a part has them.
template <typename Item, typename Wanted>
void expect_kept(const std::vector<Item>& all, const std::vector<Item>& kept, Wanted wanted, int& none,
                 int& some) {
  auto next = kept.begin();
  for (const Item& item : all) {
    const bool expected = wanted(item);
    const bool found = next != kept.end() && [&] {
      if constexpr (requires { item.body; })
        return next->body == item.body;
      else
        return next->id == item.id;
    }();
    EXPECT_EQ(found, expected);
    next += found;
    ++(expected ? some : none);
  }
  EXPECT_EQ(next, kept.end());
}

bool has_voxel(const BlockSet& set, const Box<int>& box) {
  bool found = false;
  set.for_each([&](glm::ivec3 voxel, std::uint32_t) { found = found || box.contains(voxel); });
  return found;
}

TEST_F(StateFilterTest, KeepsWhatReachesABox) {
  int none = 0, some = 0;
  const VoxelRuler ruler(level_.layout());
  for (std::uint32_t tick = 20; tick < kTicks; tick += 20) {
    const State state = state_at(tick);
    for (int round = 0; round < 10; ++round) {
      const Box<int> box = random_box(), around = grown(box);
      const State part = filtered(state, std::span(&box, 1));
      const auto inside = [&](Position p) {
        return around.contains(glm::ivec3(ruler.subvoxel(p) >> std::int64_t{10}));
      };
      expect_kept(
          state.clouds, part.clouds, [&](const LiveCloud& c) { return has_voxel(c.cloud->voxels(), around); },
          none, some);
      expect_kept(
          state.blasts, part.blasts,
          [&](const LiveBlast& b) { return has_voxel(b.field->reached(), around); }, none, some);
      expect_kept(
          state.bodies, part.bodies, [&](const Body& b) { return inside(b.position) || inside(b.previous); },
          none, some);
    }
  }
  EXPECT_GT(none, 0);
  EXPECT_GT(some, 0);
}

TEST_F(StateFilterTest, KeepsEveryHoleThatPasses) {
  // A hole must be kept if its axis comes closer to the box than its radius, and dropped if all of a bore
  // twice as wide is outside.
  int kept = 0, dropped = 0;
  for (std::uint32_t tick = 20; tick < kTicks; tick += 20) {
    const State state = state_at(tick);
    for (int round = 0; round < 10; ++round) {
      const Box<int> box = random_box();
      const State part = filtered(state, std::span(&box, 1));
      for (const BulletHole& hole : state.holes) {
        const glm::dvec3 a = metres_from_position(hole.shot.origin),
                         b = metres_from_position(hole.shot.toward);
        const double length = static_cast<double>(hole.distance) / kUnitsPerMetre,
                     radius = static_cast<double>(hole.shot.radius) / kUnitsPerMetre;
        double nearest = 1e30;  // of the axis to the box [m]
        for (int i = 0; i <= 4000; ++i) {
          const glm::dvec3 p = a + (b - a) / glm::length(b - a) * (length * i / 4000);
          const glm::dvec3 v = (p - glm::dvec3(level_.layout().origin_world)) / 0.5;
          const glm::dvec3 apart = glm::max(glm::max(glm::dvec3(box.low) - v, v - glm::dvec3(box.high)), 0.0);
          nearest = std::min(nearest, 0.5 * glm::length(apart));
        }
        const bool has =
            std::ranges::any_of(part.holes, [&](const BulletHole& h) { return h.id == hole.id; });
        if (nearest < radius) {
          EXPECT_TRUE(has) << "tick " << tick << " hole " << hole.id;
          ++kept;
        } else if (nearest > std::sqrt(3.0) * (2 * radius + 0.5 * kFilterReach) + length / 4000) {
          EXPECT_FALSE(has) << "tick " << tick << " hole " << hole.id;
          ++dropped;
        }
      }
    }
  }
  EXPECT_GT(kept, 0);
  EXPECT_GT(dropped, 0);
}

TEST_F(StateFilterTest, KeepsAGrenadeWhereItIs) {
  World world(level_, {});
  const VoxelRuler ruler(level_.layout());
  ASSERT_TRUE(world.append(ThrowSmoke{0, ruler.centre({2, 5, 16}), ruler.centre({18, 5, 16}), {}}));
  const Box<int> start{{0, 3, 14}, {4, 8, 19}}, end{{14, 3, 14}, {20, 8, 19}};
  const auto has = [&](const Box<int>& box) {
    return !filtered(world.state(), std::span(&box, 1)).flights.empty();
  };
  world.advance_to(1);
  EXPECT_TRUE(has(start));
  EXPECT_FALSE(has(end));
  world.advance_to(world.state().flights.at(0).detonation_tick - 1);
  EXPECT_FALSE(has(start));
  EXPECT_TRUE(has(end));
  // A state that was received may have a grenade that should have detonated long ago.
  State late = world.state();
  late.tick = kMaxTick;
  EXPECT_FALSE(filtered(late, std::span(&end, 1)).flights.empty());
}

TEST_F(StateFilterTest, IsNothingAllAndOnceIsEnough) {
  const Box<int> all = grown({glm::ivec3(0), level_.size()}, 1000), none{{3, 3, 3}, {3, 9, 9}};
  for (std::uint32_t tick = 0; tick < kTicks; tick += 37) {
    State state = state_at(tick);
    std::erase_if(state.clouds, [](const LiveCloud& c) { return c.cloud->voxels().empty(); });
    std::erase_if(state.blasts, [](const LiveBlast& b) { return b.field->reached().empty(); });
    EXPECT_EQ(filtered(state, std::span(&all, 1)).hash(), state.hash());
    const State empty = filtered(state, {});
    EXPECT_EQ(empty.hash(), filtered(state, std::span(&none, 1)).hash()) << "a box without a voxel";
    EXPECT_EQ(empty.clouds.size() + empty.flights.size() + empty.blasts.size() + empty.holes.size() +
                  empty.bodies.size(),
              0u);
    EXPECT_EQ(empty.events, state.events);
    EXPECT_EQ(empty.edits, state.edits);

    const std::vector<Box<int>> boxes{random_box(), random_box(), random_box()};
    const State part = filtered(state, boxes);
    EXPECT_EQ(filtered(part, boxes).hash(), part.hash());
    std::size_t most = 0;
    for (const Box<int>& box : boxes) most += filtered(state, std::span(&box, 1)).clouds.size();
    EXPECT_LE(part.clouds.size(), most);
  }
}

}  // namespace
}  // namespace brume::sim
