#include "grids/files/cut_sides.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <limits>
#include <map>
#include <tuple>

namespace brume::grids {
namespace {

/// A grid of the values of a function above 0 in a box.
Grid grid_of(glm::ivec3 low, glm::ivec3 high, const std::function<float(glm::ivec3)>& value) {
  Grid grid;
  std::map<std::tuple<int, int, int>, std::size_t> bricks;
  for (int z = low.z; z < high.z; ++z)
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x; ++x) bricks.try_emplace({z >> 3, y >> 3, x >> 3}, 0);
  for (auto& [at, number] : bricks) {
    number = grid.bricks.size();
    grid.bricks.push_back({8 * glm::ivec3(std::get<2>(at), std::get<1>(at), std::get<0>(at)), {}});
  }
  grid.values.resize(grid.bricks.size() * kBrickVoxels * sizeof(float));
  for (int z = low.z; z < high.z; ++z)
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x; ++x) {
        const std::size_t brick = bricks.at({z >> 3, y >> 3, x >> 3});
        const auto voxel = static_cast<std::size_t>((x & 7) + 8 * ((y & 7) + 8 * (z & 7)));
        const float number = value({x, y, z});
        std::memcpy(grid.values.data() + (brick * kBrickVoxels + voxel) * sizeof(float), &number,
                    sizeof number);
        grid.bricks[brick].active[voxel / 64] |= std::uint64_t{1} << voxel % 64;
      }
  return grid;
}

float ball(glm::ivec3 p, glm::vec3 middle, float radius) {
  return glm::distance(glm::vec3(p), middle) < radius ? 1.0f : 0.0f;
}

// As bakes make them: within two voxels from 0 to 1.
TEST(CutSides, AFlatShapeThatFadesIsNotCut) {
  const Grid slab = grid_of({-12, -12, -12}, {13, 13, 13}, [](glm::ivec3 p) {
    return glm::clamp(
        0.5f * (9.5f - static_cast<float>(std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}))), 0.0f,
        1.0f);
  });
  EXPECT_EQ(cut_sides(slab), Sides{});
}

TEST(CutSides, ABallIsNotCut) {
  for (const float radius : {8.0f, 13.5f}) {
    const Grid grid = grid_of(glm::ivec3(-15), glm::ivec3(16), [&](glm::ivec3 p) {
      return ball(p, {0, 0, 0}, radius);
    });
    for (const double side : cut_sides(grid)) EXPECT_LT(side, kCutSide);
  }
  // One that fades is even less so.
  const Grid soft = grid_of(glm::ivec3(-17), glm::ivec3(18),
                            [](glm::ivec3 p) { return std::max(1 - glm::length(glm::vec3(p)) / 16, 0.0f); });
  // The outermost layer of a ball of radius R is at R - 1 or beyond: less than 2 / R of its largest, here of
  // R > 14.
  for (const double side : cut_sides(soft)) EXPECT_LT(side, 2.0 / 14);
}

TEST(CutSides, AHalfBallIsCutWhereItEnds) {
  const Grid grid = grid_of({-12, 0, -12}, {13, 13, 13}, [](glm::ivec3 p) { return ball(p, {0, 0, 0}, 12); });
  const Sides sides = cut_sides(grid);
  EXPECT_EQ(sides[2], 1);
  for (const std::size_t side : {0u, 1u, 3u, 4u, 5u}) EXPECT_LT(sides[side], kCutSide) << side;
}

TEST(CutSides, ABoxIsCutOnAllSides) {
  for (const double side : cut_sides(grid_of({-3, 2, 0}, {4, 9, 7}, [](glm::ivec3) { return 2.0f; })))
    EXPECT_EQ(side, 1);
}

// A hot voxel makes nothing else thin, and thin haze at the walls is no cut.
TEST(CutSides, OddVoxelsAndHazeDecideNothing) {
  const auto value = [](glm::ivec3 p) {
    if (p == glm::ivec3(0)) return 1e6f;
    if (p == glm::ivec3(1, 0, 0)) return std::numeric_limits<float>::infinity();
    if (p == glm::ivec3(2, 0, 0)) return std::numeric_limits<float>::quiet_NaN();
    return std::max(ball(p, {0, 0, 0}, 10), 0.05f);
  };
  for (const double side : cut_sides(grid_of(glm::ivec3(-12), glm::ivec3(13), value)))
    EXPECT_LT(side, kCutSide);
}

TEST(CutSides, TilesCountAsTheirVoxels) {
  Grid grid;
  Tile tile{{0, 0, 0}, 8, true, {}};
  const float one = 1;
  std::memcpy(tile.value.data(), &one, sizeof one);
  grid.tiles.push_back(tile);
  for (const double side : cut_sides(grid)) EXPECT_EQ(side, 1);
  EXPECT_EQ(cut_sides(Grid{}), Sides{});
}

}  // namespace
}  // namespace brume::grids
