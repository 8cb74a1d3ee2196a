#include "voxel/coarse_solid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace brume::voxel {
namespace {

TEST(CoarseSolid, EdgesAreTheSmallestThatFit) {
  EXPECT_EQ(coarse_edge({40, 20, 42}, 1u << 17, 256), 1);
  EXPECT_EQ(coarse_edge({114, 38, 114}, 1u << 17, 256), 2);
  EXPECT_EQ(coarse_edge({256, 16, 256}, 1u << 20, 256), 1);
  EXPECT_EQ(coarse_edge({257, 16, 256}, 1u << 20, 256), 2);
  EXPECT_EQ(coarse_edge({4096, 4096, 4096}, 1u << 20, 256), 41);
  for (const glm::ivec3 size : {glm::ivec3(1), glm::ivec3(7, 1, 33), glm::ivec3(4096, 7, 4096),
                                glm::ivec3(1, 1, 4096), glm::ivec3(4096)}) {
    const auto fits = [&](int edge) {
      const glm::u64vec3 cells(coarse_size(size, edge));
      return cells.x * cells.y * cells.z <= 1u << 17 && std::max({cells.x, cells.y, cells.z}) <= 256;
    };
    const int edge = coarse_edge(size, 1u << 17, 256);
    EXPECT_TRUE(fits(edge));
    EXPECT_TRUE(edge == 1 || !fits(edge - 1));
  }
}

// Against a count of each cell's voxels, in a box of the cells whose last ones reach beyond the grid.
TEST(CoarseSolid, CellsAreSolidFromHalfAWallOn) {
  std::mt19937 random(3);
  for (const int edge : {1, 2, 3, 5}) {
    BitGrid grid({{33, 17, 9}, 0.5f, glm::vec3(0)});
    for_each_in(Box<int>{glm::ivec3(0), grid.size()}, [&](glm::ivec3 v) {
      if (random() % static_cast<unsigned>(2 * edge) == 0) grid.set(v, true);
    });
    const Box<int> cells{{1, 0, 1}, coarse_size(grid.size(), edge)};
    const std::vector<bool> solid = coarse_solid(grid, edge, cells);
    std::size_t next = 0;
    for_each_in(cells, [&](glm::ivec3 cell) {
      int count = 0;
      for_each_in(Box<int>{cell * edge, (cell + 1) * edge}, [&](glm::ivec3 v) { count += grid.solid(v); });
      EXPECT_EQ(solid[next++], 2 * count >= edge * edge) << edge;
    });
  }
}

}  // namespace
}  // namespace brume::voxel
