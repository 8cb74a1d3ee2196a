#include "sim/fill.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <random>
#include <string>

#include "tests/reference/dijkstra.hpp"
#include "tests/sanitized.hpp"

namespace brume::sim {
namespace {

using voxel::BitGrid;

std::int64_t index_of(glm::ivec3 size, glm::ivec3 v) {
  return v.x + std::int64_t{size.x} * (v.y + std::int64_t{size.y} * v.z);
}

std::vector<reference::Reached> as_reached(glm::ivec3 size, const std::vector<FilledVoxel>& filled) {
  std::vector<reference::Reached> result;
  for (const FilledVoxel& f : filled) result.push_back({f.distance, index_of(size, f.voxel)});
  return result;
}

std::vector<reference::Reached> expected_fill(const BitGrid& grid, glm::ivec3 source) {
  return reference::dijkstra(
      grid.size(),
      [&](int x, int y, int z) {
        return !grid.solid({x, y, z});
      },
      source);
}

enum class Maze { dust, walls, corridors };

/// Loose voxels; thick and thin walls with doors; or corridors one voxel wide carved out of solid voxels.
BitGrid make_maze(std::mt19937& random, glm::ivec3 size, Maze kind) {
  BitGrid grid({size, 0.5f, glm::vec3(0)});
  const auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
  const auto fill_box = [&](glm::ivec3 low, glm::ivec3 high, bool solid) {
    for (int z = low.z; z <= high.z; ++z)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) grid.set({x, y, z}, solid);
  };
  if (kind == Maze::dust) {
    const int percent = 5 + below(60);
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x)
          if (below(100) < percent) grid.set({x, y, z}, true);
  } else if (kind == Maze::walls) {
    for (int i = 0; i < 6; ++i) {
      const int axis = below(3);
      glm::ivec3 low(0), high = size - 1;
      low[axis] = high[axis] = below(size[axis]);
      fill_box(low, high, true);
      for (int door = 0; door < 2; ++door)
        grid.set(glm::ivec3(axis == 0 ? low.x : below(size.x), axis == 1 ? low.y : below(size.y),
                            axis == 2 ? low.z : below(size.z)),
                 false);
    }
  } else {
    fill_box(glm::ivec3(0), size - 1, true);
    glm::ivec3 at(below(size.x), below(size.y), below(size.z));
    for (int i = 0; i < 3 * (size.x + size.y + size.z); ++i) {
      const int axis = below(3), step = below(2) * 2 - 1;
      for (int run = 1 + below(6); run > 0; --run) {
        at[axis] = std::clamp(at[axis] + step, 0, size[axis] - 1);
        grid.set(at, false);
      }
    }
  }
  return grid;
}

glm::ivec3 any_free(std::mt19937& random, const BitGrid& grid) {
  const glm::ivec3 size = grid.size();
  for (;;) {
    const glm::ivec3 v(static_cast<int>(random() % static_cast<unsigned>(size.x)),
                       static_cast<int>(random() % static_cast<unsigned>(size.y)),
                       static_cast<int>(random() % static_cast<unsigned>(size.z)));
    if (grid.free(v)) return v;
  }
}

TEST(Fill, MatchesDijkstraOn200Mazes) {
  const std::array<glm::ivec3, 8> sizes{
      {{1, 1, 1}, {7, 7, 7}, {33, 17, 5}, {5, 33, 17}, {1, 40, 3}, {8, 8, 8}, {16, 9, 24}, {20, 20, 20}}};
  for (unsigned seed = 0; seed < 200; seed += kSanitized ? 5 : 1) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    BitGrid grid = make_maze(random, sizes[seed % sizes.size()], static_cast<Maze>(seed % 3));
    grid.set(glm::ivec3(0), false);
    const glm::ivec3 source = any_free(random, grid);
    const std::vector<reference::Reached> all = expected_fill(grid, source);

    // The whole space, one voxel more than exists, and random amounts.
    for (const std::size_t budget : {all.size(), all.size() + 1, std::size_t{1} + random() % all.size()}) {
      std::vector<reference::Reached> nearest(all.begin(),
                                              all.begin() + static_cast<long>(std::min(budget, all.size())));
      ASSERT_EQ(as_reached(grid.size(), flood_fill(grid, source, static_cast<std::uint32_t>(budget))),
                nearest);
    }
  }
}

BlockSet free_voxels(const BitGrid& grid) {
  std::vector<glm::ivec3> voxels;
  for (int z = 0; z < grid.size().z; ++z)
    for (int y = 0; y < grid.size().y; ++y)
      for (int x = 0; x < grid.size().x; ++x)
        if (grid.free({x, y, z})) voxels.push_back({x, y, z});
  return BlockSet(voxels);
}

TEST(Fill, IsTheSameAsAListAndAsASet) {
  for (unsigned seed = 0; seed < 60; seed += kSanitized ? 5 : 1) {
    SCOPED_TRACE("seed " + std::to_string(seed));
    std::mt19937 random(seed);
    BitGrid grid = make_maze(random, {33, 17, 20}, static_cast<Maze>(seed % 3));
    grid.set(glm::ivec3(0), false);
    const glm::ivec3 source = any_free(random, grid);
    for (const std::uint32_t budget : {1u, static_cast<std::uint32_t>(random() % 3000), 100000u}) {
      const std::vector<FilledVoxel> list = flood_fill(grid, source, budget);
      const Flood flood = flood_set(grid, source, budget);
      ASSERT_EQ(flood.voxels.size(), list.size());
      ASSERT_EQ(flood.distances.size(), list.size());
      std::map<std::uint32_t, std::uint64_t> within;  // voxels within each distance
      for (std::size_t i = 0; i < list.size(); ++i) {
        const std::uint32_t rank = flood.voxels.rank(list[i].voxel);
        ASSERT_NE(rank, BlockSet::kNone);
        EXPECT_EQ(flood.distances[rank], list[i].distance);
        within[list[i].distance] = i + 1;
      }
      ASSERT_EQ(flood.counts.size(), within.size());
      for (const Flood::Count& at : flood.counts) EXPECT_EQ(at.count, within[at.distance]);

      // A fill of its own voxels is the same; so is what faces connect, unless the budget cut it off.
      const Flood again = flood_set(flood.voxels, source);
      EXPECT_EQ(again.voxels, flood.voxels);
      EXPECT_EQ(again.distances, flood.distances);
      EXPECT_EQ(connected_part(flood.voxels, source), flood.voxels);
      if (list.size() < budget) {
        EXPECT_EQ(connected_part(free_voxels(grid), source), flood.voxels);
      }
    }
  }
}

TEST(Fill, VoxelsOfTwoSetsHaveTheRanksOfBoth) {
  std::mt19937 random(3);
  for (int round = 0; round < 20; ++round) {
    std::vector<glm::ivec3> voxels[2];
    for (auto& list : voxels)
      for (int i = 0; i < 400; ++i)
        list.push_back({static_cast<int>(random() % 9) - 3, static_cast<int>(random() % 9),
                        static_cast<int>(random() % 9)});
    const BlockSet a(voxels[0]), b(voxels[1]);
    std::uint32_t next = 0;
    for_each_with(a, b, [&](glm::ivec3 voxel, std::uint32_t rank, std::uint32_t rank_in_b) {
      EXPECT_EQ(rank, next++);
      EXPECT_EQ(rank, a.rank(voxel));
      EXPECT_EQ(rank_in_b, b.rank(voxel));
    });
    EXPECT_EQ(next, a.size());
    std::vector<glm::ivec3> even;
    const BlockSet kept = filter(a, [&](glm::ivec3 voxel, std::uint32_t rank) {
      EXPECT_EQ(rank, a.rank(voxel));
      if (rank % 2 == 0) even.push_back(voxel);
      return rank % 2 == 0;
    });
    EXPECT_EQ(kept, BlockSet(even));
    EXPECT_EQ(kept.size(), (a.size() + 1) / 2);
    glm::ivec3 low = voxels[0][0], high = low;
    for (const glm::ivec3 v : voxels[0]) low = glm::min(low, v), high = glm::max(high, v);
    EXPECT_EQ(a.low(), low);
    EXPECT_EQ(a.high(), high);
  }
}

TEST(Fill, IsEmptyForASourceInASolidOrOutside) {
  BitGrid grid({{7, 7, 7}, 0.5f, glm::vec3(0)});
  grid.set({3, 3, 3}, true);
  EXPECT_TRUE(flood_fill(grid, {3, 3, 3}, 10).empty());
  EXPECT_TRUE(flood_fill(grid, {-1, 3, 3}, 10).empty());
  EXPECT_TRUE(flood_fill(grid, {3, 7, 3}, 10).empty());
  EXPECT_TRUE(flood_fill(grid, {0, 0, 0}, 0).empty());
}

TEST(Fill, DoesNotSlipThroughDiagonalCracks) {
  // A staircase of voxels that touch at their edges only closes off one corner of the grid.
  BitGrid grid({{12, 12, 4}, 0.5f, glm::vec3(0)});
  for (int z = 0; z < 4; ++z)
    for (int x = 0; x < 12; ++x) grid.set({x, 11 - x, z}, true);
  for (const FilledVoxel& f : flood_fill(grid, {0, 0, 0}, 10000)) EXPECT_LT(f.voxel.x + f.voxel.y, 11);
  EXPECT_EQ(flood_fill(grid, {0, 0, 0}, 10000).size(), 66u * 4);

  // The same with voxels that touch at their corners only, around a single voxel.
  BitGrid cage({{5, 5, 5}, 0.5f, glm::vec3(0)});
  for (const glm::ivec3 face :
       {glm::ivec3(1, 0, 0), {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}})
    cage.set(glm::ivec3(2) + face, true);
  EXPECT_EQ(flood_fill(cage, {2, 2, 2}, 100).size(), 1u);
}

TEST(Fill, StaysOnItsSideOfAWall) {
  BitGrid grid({{33, 17, 20}, 0.5f, glm::vec3(0)});
  for (int z = 0; z < 20; ++z)
    for (int y = 0; y < 17; ++y) grid.set({8, y, z}, true);
  for (const FilledVoxel& f : flood_fill(grid, {2, 2, 2}, 100000)) ASSERT_LT(f.voxel.x, 8);
}

/// Distances by voxel: ignores the order among equal distances.
std::map<std::int64_t, std::uint32_t> distances(glm::ivec3 size, const std::vector<FilledVoxel>& filled,
                                                const std::function<glm::ivec3(glm::ivec3)>& back) {
  std::map<std::int64_t, std::uint32_t> result;
  for (const FilledVoxel& f : filled) result[index_of(size, back(f.voxel))] = f.distance;
  return result;
}

TEST(Fill, IsInvariantUnderTranslationAndAxisPermutation) {
  for (unsigned seed = 0; seed < 12; ++seed) {
    std::mt19937 random(seed);
    const glm::ivec3 size(19, 11, 14);
    BitGrid grid = make_maze(random, size, static_cast<Maze>(seed % 3));
    const glm::ivec3 source = any_free(random, grid);
    const auto same = [](glm::ivec3 v) { return v; };
    const auto plain = distances(size, flood_fill(grid, source, 100000), same);

    // Translated by a random number of voxels, in solid surroundings.
    const glm::ivec3 shift(3, 13, 6);
    BitGrid moved({size + shift + 5, 0.5f, glm::vec3(0)});
    for (int z = 0; z < moved.size().z; ++z)
      for (int y = 0; y < moved.size().y; ++y)
        for (int x = 0; x < moved.size().x; ++x)
          moved.set({x, y, z}, !grid.free(glm::ivec3(x, y, z) - shift));
    EXPECT_EQ(
        distances(size, flood_fill(moved, source + shift, 100000), [&](glm::ivec3 v) { return v - shift; }),
        plain);

    // Permuted axes: (x, y, z) -> (y, z, x).
    const auto turn = [](glm::ivec3 v) { return glm::ivec3(v.y, v.z, v.x); };
    const auto turn_back = [](glm::ivec3 v) { return glm::ivec3(v.z, v.x, v.y); };
    BitGrid turned({turn(size), 0.5f, glm::vec3(0)});
    for (int z = 0; z < size.z; ++z)
      for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) turned.set(turn({x, y, z}), grid.solid({x, y, z}));
    EXPECT_EQ(distances(size, flood_fill(turned, turn(source), 100000), turn_back), plain);
  }
}

TEST(Fill, IsRoundInOpenAir) {
  BitGrid grid({{64, 64, 64}, 0.5f, glm::vec3(0)});
  double nearest_outside = 1e9, farthest_inside = 0;
  std::vector<bool> inside(64 * 64 * 64);
  for (const FilledVoxel& f : flood_fill(grid, {32, 32, 32}, 30000)) {
    inside[static_cast<std::size_t>(index_of(grid.size(), f.voxel))] = true;
    farthest_inside = std::max(farthest_inside, glm::length(glm::dvec3(f.voxel) - 32.0));
  }
  for (int i = 0; i < 64 * 64 * 64; ++i)
    if (!inside[static_cast<std::size_t>(i)])
      nearest_outside =
          std::min(nearest_outside, glm::length(glm::dvec3(i & 63, i >> 6 & 63, i >> 12) - 32.0));
  // For a step of lengths x >= y >= z the metric is (10 x + 4 y + 3 z) / 10: over the Euclidean length at
  // most
  // |(10, 4, 3)| / 10 = 1.1181, at least 17 / (10 sqrt(3)) = 0.9814. One voxel of rounding on each side.
  EXPECT_LT((farthest_inside - 1) / (nearest_outside + 1), 1.1181 / 0.9814);
}

}  // namespace
}  // namespace brume::sim
