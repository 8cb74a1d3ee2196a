// What is seen of a density, and how deep it is, of forms whose values are known.
#include "grids/density_extent.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>

#include "grids/generate.hpp"

namespace brume::grids {
namespace {

/// A cube of bricks whose values are `value_at` of their voxel.
template <typename ValueAt>
BrickVolume cube_of(int bricks, double voxel, ValueAt value_at) {
  Grid grid;
  grid.name = "density";
  grid.world_from_index = glm::scale(glm::dmat4(1), glm::dvec3(voxel));
  for (int b = 0; b < bricks * bricks * bricks; ++b) {
    Brick& brick = grid.bricks.emplace_back();
    brick.origin = 8 * glm::ivec3(b % bricks, b / bricks % bricks, b / (bricks * bricks));
    for (int i = 0; i < int{kBrickVoxels}; ++i) {
      const float value = value_at(brick.origin + glm::ivec3(i & 7, i >> 3 & 7, i >> 6));
      if (value != 0) brick.active[static_cast<std::size_t>(i / 64)] |= std::uint64_t{1} << (i % 64);
      const auto* const bytes = reinterpret_cast<const std::byte*>(&value);
      grid.values.insert(grid.values.end(), bytes, bytes + sizeof value);
    }
  }
  return make_brick_volume(grid).value_or_throw();
}

TEST(DensityExtent, OfACubeIsItsEdge) {
  const DensityExtent extent = measure_extent(cube_of(3, 0.5, [](glm::ivec3) { return 2.0f; }), 0.01f);
  EXPECT_EQ(extent.seen.low, glm::vec3(0));
  EXPECT_EQ(extent.seen.high, glm::vec3(24));
  EXPECT_DOUBLE_EQ(extent.depth, 24 * 0.5 * 2);
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
  EXPECT_EQ(measure_extent(volume, 0.01f).seen.high, glm::vec3(16, 12, 16));
  EXPECT_EQ(measure_extent(volume, 0.4f).seen.high, glm::vec3(16, 8, 16));
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
