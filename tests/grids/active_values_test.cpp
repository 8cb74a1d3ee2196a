#include "grids/grid.hpp"

#include <gtest/gtest.h>

#include <set>
#include <tuple>

#include "tests/grids/sample_grids.hpp"

namespace brume::grids {
namespace {

TEST(ActiveValues, AreThoseThatTheGridCalls) {
  for (const ValueType type : {ValueType::float32, ValueType::vec3d, ValueType::boolean}) {
    const Grid grid = random_grid(type, 5);
    std::uint64_t count = 0;
    std::set<std::tuple<int, int, int>> places;
    Box<double> bounds{glm::dvec3(1e30), glm::dvec3(-1e30)};
    EXPECT_TRUE(for_each_active(grid, [&](const ActiveValue& active) {
      count += active.count();
      EXPECT_TRUE(places.emplace(active.low.x, active.low.y, active.low.z).second);
      bounds.low = glm::min(bounds.low, glm::dvec3(active.low) - 0.5);
      bounds.high = glm::max(bounds.high, glm::dvec3(active.low) + (static_cast<double>(active.edge) - 0.5));
      if (active.edge > 1) return;
      const auto brick = find_brick(grid, active.low & ~7);
      ASSERT_TRUE(brick);
      const glm::uvec3 local(active.low & 7);
      const std::size_t voxel = local.x + 8 * (local.y + 8 * local.z);
      EXPECT_TRUE(grid.bricks[*brick].is_active(voxel));
      EXPECT_EQ(active.value, grid.values_of(*brick).data() + voxel * bytes_of(type));
    }));
    EXPECT_GT(count, 10u);
    EXPECT_EQ(count, count_active(grid));
    EXPECT_EQ(bounds.low, active_bounds(grid).low);
    EXPECT_EQ(bounds.high, active_bounds(grid).high);
  }
}

TEST(ActiveValues, EndWhereTheCallerHasEnough) {
  const Grid grid = random_grid(ValueType::float32, 5);
  int calls = 0;
  EXPECT_FALSE(for_each_active(grid, [&](const ActiveValue&) { return ++calls < 4; }));
  EXPECT_EQ(calls, 4);
}

}  // namespace
}  // namespace brume::grids
