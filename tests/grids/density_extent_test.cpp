// What is seen of a density, and how deep it is, of forms whose values are known.
#include "grids/density_extent.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "grids/generate.hpp"

namespace brume::grids {
namespace {

/// Bricks whose values are `value_at` of their voxel.
template <typename ValueAt>
BrickVolume volume_of(std::vector<glm::ivec3> bricks, double voxel, ValueAt value_at) {
  std::ranges::sort(bricks, goes_before);
  bricks.erase(std::unique(bricks.begin(), bricks.end()), bricks.end());
  Grid grid;
  grid.name = "density";
  grid.world_from_index = glm::scale(glm::dmat4(1), glm::dvec3(voxel));
  for (const glm::ivec3 at : bricks) {
    Brick& brick = grid.bricks.emplace_back();
    brick.origin = 8 * at;
    for (int i = 0; i < int{kBrickVoxels}; ++i) {
      const float value = value_at(brick.origin + glm::ivec3(i & 7, i >> 3 & 7, i >> 6));
      if (value != 0) brick.active[static_cast<std::size_t>(i / 64)] |= std::uint64_t{1} << (i % 64);
      const auto* const bytes = reinterpret_cast<const std::byte*>(&value);
      grid.values.insert(grid.values.end(), bytes, bytes + sizeof value);
    }
  }
  return make_brick_volume(grid).value_or_throw();
}

std::vector<glm::ivec3> cube_bricks(int edge) {
  std::vector<glm::ivec3> bricks;
  for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(edge)}, [&](glm::ivec3 at) { bricks.push_back(at); });
  return bricks;
}

template <typename ValueAt>
BrickVolume cube_of(int bricks, double voxel, ValueAt value_at) {
  return volume_of(cube_bricks(bricks), voxel, value_at);
}

TEST(DensityExtent, OfACubeIsItsEdge) {
  const DensityExtent extent = measure_extent(cube_of(3, 0.5, [](glm::ivec3) { return 2.0f; }), 0.01f);
  // Beside it the value falls from 1 to 0 within half a voxel on either side of its faces.
  const float beyond = 0.5f - 0.01f;
  EXPECT_EQ(extent.seen.low, glm::vec3(-beyond));
  EXPECT_EQ(extent.seen.high, glm::vec3(24 + beyond));
  EXPECT_EQ(extent.bulk.low, glm::vec3(-0.5f));
  EXPECT_EQ(extent.bulk.high, glm::vec3(24.5f));
  EXPECT_EQ(extent.stray_part, 0);
  EXPECT_DOUBLE_EQ(extent.depth, 24 * 0.5 * 2);
}

// What a filter finds between centres is seen, too: of one voxel nearly twice its edge.
TEST(DensityExtent, OfAVoxelReachesBeyondIt) {
  const BrickVolume volume =
      cube_of(1, 1, [](glm::ivec3 p) { return p == glm::ivec3(3, 4, 5) ? 7.0f : 0.0f; });
  const DensityExtent extent = measure_extent(volume, 0.01f);
  for (int axis = 0; axis < 3; ++axis) {
    const float centre = 3.5f + static_cast<float>(axis);
    EXPECT_FLOAT_EQ(extent.seen.low[axis], centre - 0.99f);
    EXPECT_FLOAT_EQ(extent.seen.high[axis], centre + 0.99f);
  }
}

/// A ball of 38 voxels, and a row of a few at an index.
BrickVolume ball_and(glm::ivec3 stray, float value, int count = 1) {
  std::vector<glm::ivec3> bricks = cube_bricks(5);
  for (int i = 0; i < count; ++i) bricks.push_back((stray + glm::ivec3(i, 0, 0)) >> 3);
  return volume_of(bricks, 0.5, [&](glm::ivec3 p) {
    if (p.y == stray.y && p.z == stray.z && p.x >= stray.x && p.x < stray.x + count) return value;
    return glm::distance(glm::vec3(p), glm::vec3(20)) < 19 ? 1.0f : 0.0f;
  });
}

TEST(DensityExtent, WhatLiesFarAwayStrays) {
  const DensityExtent alone = measure_extent(ball_and({20, 20, 20}, 1), 0.01f);
  for (const float value : {1e-3f, 0.02f, 1.0f, 1e3f}) {
    const DensityExtent extent = measure_extent(ball_and({310, 20, 20}, value), 0.01f);
    EXPECT_EQ(extent.seen, alone.seen) << value;
    EXPECT_EQ(extent.bulk, alone.bulk) << value;
    EXPECT_EQ(extent.depth, alone.depth) << value;
    // One of 4/3 pi 19^3 voxels, give or take those of the surface.
    EXPECT_NEAR(1 / extent.stray_part, 4 / 3.0 * 3.14159 * 19 * 19 * 19, 3 * 19 * 19);
    // From the bulk's face to that of the voxel's reach.
    EXPECT_DOUBLE_EQ(extent.stray_reach, 0.5 * (310 - 0.5 - double{alone.bulk.high.x}));
  }
}

TEST(DensityExtent, WhatIsNearOrMuchDoesNotStray) {
  // As far away as the ball is wide.
  const DensityExtent near = measure_extent(ball_and({75, 20, 20}, 1), 0.01f);
  EXPECT_EQ(near.stray_part, 0);
  EXPECT_GT(near.seen.high.x, 76);
  // A row of 200 of 28,900 voxels is 0.7 % of them.
  const DensityExtent much = measure_extent(ball_and({110, 20, 20}, 1, 200), 0.01f);
  EXPECT_EQ(much.stray_part, 0);
  EXPECT_GT(much.seen.high.x, 310);
}

TEST(DensityExtent, OfABallIsNearlyItsDiameter) {
  // Columns of 8 x 8 voxels; 95 % of those that meet a ball of 48 are at least 6 voxels off its middle.
  const float radius = 48;
  const DensityExtent extent = measure_extent(
      cube_of(12, 1,
              [&](glm::ivec3 p) {
                return glm::distance(glm::vec3(p) + 0.5f, glm::vec3(48)) < radius ? 1.0f : 0.0f;
              }),
      0.01f);
  EXPECT_GT(extent.depth, 0.9 * 2 * double{radius});
  EXPECT_LE(extent.depth, 2 * double{radius});
}

TEST(DensityExtent, AHotVoxelDecidesNothing) {
  const auto block = [](glm::ivec3) { return 1.0f; };
  const auto spike = [](glm::ivec3 p) { return p == glm::ivec3(3, 4, 5) ? 1e3f : 1.0f; };
  const BrickVolume plain = cube_of(2, 1, block), hot = cube_of(2, 1, spike);
  EXPECT_EQ(hot.high, 1e3f);
  EXPECT_EQ(hot.densest, 1);
  EXPECT_EQ(hot.usual, 1);
  const DensityExtent a = measure_extent(plain, 0.01f), b = measure_extent(hot, 0.01f);
  EXPECT_EQ(a.seen, b.seen);
  // A column more or less.
  EXPECT_NEAR(a.depth, b.depth, 0.01);
}

TEST(DensityExtent, WhatIsTooThinIsNotSeen) {
  const BrickVolume volume = cube_of(2, 1, [](glm::ivec3 p) {
    return p.y < 8 ? 1.0f : p.y < 12 ? 0.02f : 0.005f;
  });
  // Half a voxel of a value v beyond a face, less what the filter finds below the least that is seen.
  const auto high = [&](float fraction) { return measure_extent(volume, fraction).seen.high; };
  EXPECT_NEAR(high(0.01f).y, 12, 1e-3f);
  EXPECT_NEAR(high(0.01f).x, 16.49f, 1e-5f);
  EXPECT_NEAR(high(0.4f).y, 8.1f, 1e-5f);
}

TEST(DensityExtent, PercentilesAreThoseOfTheValues) {
  // 4,096 values from 1 to 4,096: halves have 11 bits.
  const BrickVolume volume =
      cube_of(2, 1, [](glm::ivec3 p) { return static_cast<float>(1 + p.x + 16 * (p.y + 16 * p.z)); });
  EXPECT_NEAR(volume.usual, 0.9f * 4096, 4096 / 1024.0f);
  EXPECT_NEAR(volume.densest, 0.999f * 4096, 4096 / 1024.0f);
}

TEST(DensityExtent, OfNothingIsEmpty) {
  const BrickVolume volume = cube_of(1, 1, [](glm::ivec3) { return 0.0f; });
  const DensityExtent extent = measure_extent(volume, 0.01f);
  EXPECT_TRUE(extent.seen.empty());
  EXPECT_EQ(extent.depth, 0);
  EXPECT_EQ(volume.usual, 0);
}

}  // namespace
}  // namespace brume::grids
