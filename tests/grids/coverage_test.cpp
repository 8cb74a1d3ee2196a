#include "grids/coverage.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

namespace brume::grids {
namespace {

/// Voxels above 0 at random places of two bricks, one of them below 0.
Grid sparse_grid(const glm::dmat4& world_from_index) {
  Grid grid;
  grid.world_from_index = world_from_index;
  std::minstd_rand random(7);
  for (const int x : {-8, 16}) {
    Brick& brick = grid.bricks.emplace_back();
    brick.origin = {x, 0, 8};
    brick.active.fill(~std::uint64_t{0});
    for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
      const float value = random() % 60 == 0 ? 2.0f : random() % 2 == 0 ? 0.0f : -1.0f;
      const auto* const bytes = reinterpret_cast<const std::byte*>(&value);
      grid.values.insert(grid.values.end(), bytes, bytes + sizeof value);
    }
  }
  return grid;
}

bool is_covered(const Grid& covered, glm::ivec3 index) {
  const auto brick = find_brick(covered, index & ~7);
  const glm::ivec3 in = index & 7;
  return brick && covered.bricks[*brick].is_active(static_cast<std::size_t>(in.x + 8 * (in.y + 8 * in.z)));
}

TEST(Coverage, HoldsWhateverFilteringFinds) {
  const glm::dmat4 turned =
      glm::rotate(glm::translate(glm::dmat4(1), {0.3, -2, 1}), 0.7, glm::normalize(glm::dvec3(1, 2, 3)));
  const Grid grid = sparse_grid(turned);
  for (const double voxel : {0.4, 1.0, 3.0}) {
    const glm::dmat4 other = glm::scale(glm::dmat4(1), glm::dvec3(voxel));
    const auto covered = make_coverage(grid, other);
    ASSERT_TRUE(covered);
    EXPECT_EQ(covered->world_from_index, other);
    EXPECT_EQ(covered->values.size(), covered->bricks.size() * kBrickVoxels);
    for (std::size_t i = 1; i < covered->bricks.size(); ++i)
      EXPECT_TRUE(goes_before(covered->bricks[i - 1].origin, covered->bricks[i].origin));
    // Points where interpolation reaches a voxel above 0, and what interpolation reads there.
    std::minstd_rand random(11);
    const auto fraction = [&] { return static_cast<double>(random() % 2001) / 1000 - 1; };
    for (std::size_t b = 0; b < grid.bricks.size(); ++b)
      for (std::size_t i = 0; i < kBrickVoxels; ++i) {
        if (!(to_number(grid.type, grid.values_of(b).data() + i * sizeof(float)) > 0)) continue;
        const glm::dvec3 centre(grid.bricks[b].origin + glm::ivec3(i & 7, i >> 3 & 7, i >> 6));
        const glm::dvec4 p(centre + 0.999 * glm::dvec3(fraction(), fraction(), fraction()), 1);
        const glm::ivec3 low(glm::floor(glm::dvec3(glm::inverse(other) * turned * p)));
        for (int corner = 0; corner < 8; ++corner)
          EXPECT_TRUE(is_covered(*covered, low + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2)));
      }
  }
}

TEST(Coverage, IsNothingWhereItTakesTooManyVoxels) {
  const Grid grid = sparse_grid(glm::dmat4(1));
  EXPECT_FALSE(make_coverage(grid, glm::scale(glm::dmat4(1), glm::dvec3(1e-3))));
  EXPECT_FALSE(make_coverage(grid, glm::scale(glm::dmat4(1), glm::dvec3(1, 0, 1))));
  const auto none = make_coverage(Grid(), glm::dmat4(1));
  ASSERT_TRUE(none);
  EXPECT_TRUE(none->bricks.empty());
}

}  // namespace
}  // namespace brume::grids
