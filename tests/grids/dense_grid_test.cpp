#include "grids/dense_grid.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <random>

#include "tests/grids/sample_grids.hpp"

namespace brume::grids {
namespace {

DenseGrid dense_of(glm::uvec3 size, const Box<double>& box, double (*value)(const glm::dvec3&)) {
  DenseGrid grid{"d", size, box, {}};
  for (glm::uvec3 at(0); at.z < size.z; ++at.z)
    for (at.y = 0; at.y < size.y; ++at.y)
      for (at.x = 0; at.x < size.x; ++at.x)
        grid.values.push_back(
            static_cast<float>(value(box.low + (glm::dvec3(at) + 0.5) * grid.voxel_size())));
  return grid;
}

double linear(const glm::dvec3& p) {
  return 0.25 * p.x - 0.5 * p.y + p.z + 4;
}

constexpr Box<double> kBox{glm::dvec3(-1, 2, 3), glm::dvec3(2, 5, 6.5)};

TEST(DenseGrid, KeepsValuesAtTheSameVoxels) {
  for (const glm::uvec3 size : {glm::uvec3(1), glm::uvec3(7, 1, 3), glm::uvec3(33, 17, 5)}) {
    DenseGrid dense = dense_of(size, kBox, linear);
    std::mt19937 random(3);
    for (float& value : dense.values) value += std::uniform_real_distribution<float>(-1, 1)(random);
    const Grid grid = to_grid(dense);
    const Grid* const only = &grid;
    const GridBox box = box_of(std::span(&only, 1)).value_or_throw();
    EXPECT_EQ(box.size, size);
    EXPECT_LT(glm::length(box.box.low - kBox.low) + glm::length(box.box.high - kBox.high), 1e-12);
    EXPECT_EQ(resample(grid, box).value_or_throw().values, dense.values);
  }
}

// Larger voxels hold means: the integral over the box stays.
TEST(DenseGrid, KeepsTheIntegralInLargerVoxels) {
  DenseGrid dense = dense_of({30, 17, 9}, kBox, linear);
  std::mt19937 random(4);
  for (float& value : dense.values) value = std::uniform_real_distribution<float>(0, 1)(random);
  const Grid grid = to_grid(dense);
  double mean = 0;
  for (const float value : dense.values) mean += double{value} / static_cast<double>(dense.values.size());
  for (const glm::uvec3 size :
       {glm::uvec3(1), glm::uvec3(7, 1, 3), glm::uvec3(30, 16, 9), glm::uvec3(10, 17, 3)}) {
    const DenseGrid coarse = resample(grid, {glm::dmat4(1), kBox, size}).value_or_throw();
    double sum = 0;
    for (const float value : coarse.values) sum += double{value} / static_cast<double>(coarse.values.size());
    // Each of the values, in [0, 1], is rounded to a float.
    EXPECT_NEAR(sum, mean, 1e-7);
  }
}

// Between voxel centres values are linear: a linear function stays one where it does not meet the outside.
TEST(DenseGrid, IsLinearInSmallerVoxels) {
  const DenseGrid dense = dense_of({12, 12, 14}, kBox, linear);
  const glm::dvec3 voxel = dense.voxel_size();
  const Box<double> inner{kBox.low + voxel, kBox.high - voxel};
  const DenseGrid fine = resample(to_grid(dense), {glm::dmat4(1), inner, {37, 41, 43}}).value_or_throw();
  const DenseGrid expected = dense_of({37, 41, 43}, inner, linear);
  for (std::size_t i = 0; i < fine.values.size(); ++i)
    // Of values below 16: the source's and the result's rounding to float.
    ASSERT_NEAR(double{fine.values[i]}, double{expected.values[i]}, 2e-6);
}

// Tiles are what bricks of the same value are.
TEST(DenseGrid, ReadsTilesAsBricks) {
  Grid tiles, bricks;
  Tile tile{glm::ivec3(8, -8, 0), 8, true, {}};
  const float value = 0.75f;
  std::memcpy(tile.value.data(), &value, sizeof value);
  tiles.tiles = {tile};
  Brick brick{tile.origin};
  brick.active.fill(~std::uint64_t{0});
  bricks.bricks = {brick};
  const std::vector<float> values(kBrickVoxels, value);
  const auto bytes = std::as_bytes(std::span(values));
  bricks.values.assign(bytes.begin(), bytes.end());
  for (const glm::uvec3 size : {glm::uvec3(20, 12, 10), glm::uvec3(5, 6, 7), glm::uvec3(61, 31, 33)}) {
    const GridBox box{glm::dmat4(1), {glm::dvec3(2, -9, -1), glm::dvec3(19, 3, 9.5)}, size};
    EXPECT_EQ(resample(tiles, box).value_or_throw().values, resample(bricks, box).value_or_throw().values);
  }
}

TEST(DenseGrid, ReadsEveryType) {
  for (const ValueType type : kAllTypes) {
    Grid grid = random_grid(type, 7);
    grid.world_from_index = glm::dmat4(1);
    for (const float value : resample(grid, {glm::dmat4(1), {glm::dvec3(-20), glm::dvec3(20)}, {9, 40, 80}})
                                 .value_or_throw()
                                 .values)
      // Random floats include infinities, whose difference is no number.
      EXPECT_FALSE(std::isnan(value) && (type == ValueType::int32 || type == ValueType::mask))
          << name_of(type);
  }
}

TEST(DenseGrid, RefusesOtherAxes) {
  DenseGrid dense = dense_of({4, 4, 4}, kBox, linear);
  const Grid straight = to_grid(dense);
  const Grid rotated = to_grid(dense, glm::dmat4({0, 1, 0, 0}, {-1, 0, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}));
  const Grid* both[] = {&straight, &rotated};
  EXPECT_FALSE(box_of(both));
  EXPECT_FALSE(resample(rotated, {glm::dmat4(1), kBox, {4, 4, 4}}));
  const Grid* const alone = &rotated;
  const GridBox box = box_of(std::span(&alone, 1)).value_or_throw();
  EXPECT_EQ(resample(rotated, box).value_or_throw().values, dense.values);
}

TEST(DenseGrid, RefusesWhatIsTooLarge) {
  const Grid huge = huge_tile();
  const Grid* const only = &huge;
  const GridBox box = box_of(std::span(&only, 1)).value_or_throw();
  EXPECT_EQ(box.size, glm::uvec3(4096));
  const DenseGrid small = resample(huge, {box.world_from_box, box.box, {4, 3, 5}}).value_or_throw();
  for (const float value : small.values) EXPECT_EQ(value, small.values[0]);
  EXPECT_FALSE(resample(huge, {glm::dmat4(1), {glm::dvec3(0), glm::dvec3(1e8)}, {4, 4, 4}}));
  EXPECT_FALSE(resample(huge, {glm::dmat4(1), {glm::dvec3(0), glm::dvec3(1e300)}, {4, 4, 4}}));
}

}  // namespace
}  // namespace brume::grids
