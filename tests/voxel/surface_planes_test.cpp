#include "voxel/surface_planes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "core/tasks.hpp"
#include "tests/voxel/random.hpp"
#include "voxel/voxelize.hpp"

namespace brume::voxel {
namespace {

using glm::ivec3;
using glm::vec3;

struct Built {
  BitGrid grid;
  SurfacePlanes planes;
};

Built build(const std::vector<Triangle>& triangles, const GridLayout& layout) {
  Built built{*voxelize(triangles, layout), {}};
  built.planes = SurfacePlanes::build(triangles, built.grid);
  return built;
}

// A parallelogram of two triangles.
void add_face(std::vector<Triangle>& out, vec3 corner, vec3 u, vec3 v) {
  out.push_back({corner, corner + u, corner + u + v});
  out.push_back({corner, corner + u + v, corner + v});
}

vec3 centre(ivec3 cell) {
  return vec3(cell) + 1.0f;
}

TEST(SurfacePlanes, AThinWallIsOnePlaneAtItsCentre) {
  // Two faces 0.2 voxels apart (0.1 m at 0.5 m), both within one layer of cells.
  const GridLayout layout{{12, 6, 9}, 0.5f, vec3(-2, 0, 1)};
  for (int axis = 0; axis < 3; ++axis)
    for (const float at : {3.62f, 3.9f, 4.0f, 4.13f, 4.37f}) {
      vec3 corner(-50), u(0), v(0), step(0);
      u[(axis + 1) % 3] = v[(axis + 2) % 3] = 200;
      step[axis] = 0.1f;
      corner[axis] = layout.origin_world[axis] + 0.5f * at - 0.05f;
      std::vector<Triangle> wall;
      add_face(wall, corner, u, v);
      add_face(wall, corner + step, v, u);
      const Built built = build(wall, layout);
      ivec3 cell(2);
      cell[axis] = 3;  // Spans [3.5, 4.5).
      for (cell[(axis + 1) % 3] = -1; cell[(axis + 1) % 3] < layout.size[(axis + 1) % 3];
           ++cell[(axis + 1) % 3]) {
        const auto planes = built.planes.at(cell);
        ASSERT_EQ(planes.size(), 1u);
        EXPECT_NEAR(planes[0].normal[axis], 1, 1e-6);
        EXPECT_NEAR(planes[0].offset, at - 4, 1e-4);
      }
      cell = ivec3(2);
      cell[axis] = 2;
      EXPECT_TRUE(built.planes.at(cell).empty());
      cell[axis] = 4;
      EXPECT_TRUE(built.planes.at(cell).empty());
    }
}

TEST(SurfacePlanes, ASlantedWallIsItsPlaneInEveryCell) {
  const GridLayout layout{{17, 9, 13}, 0.5f, vec3(0)};
  std::mt19937 random(4);
  std::uniform_real_distribution<float> uniform(-1, 1);
  for (int i = 0; i < 20; ++i) {
    const vec3 n = glm::normalize(vec3(uniform(random), uniform(random), uniform(random)));
    const vec3 u = glm::normalize(glm::cross(n, vec3(0.3f, 0.5f, 0.8f))), v = glm::cross(n, u);
    const vec3 middle = 0.25f * vec3(layout.size);  // [m]
    std::vector<Triangle> wall;
    add_face(wall, middle - 40.0f * u - 40.0f * v, 80.0f * u, 80.0f * v);
    const Built built = build(wall, layout);
    ASSERT_GT(built.planes.cell_count(), 50u);
    for (int z = -1; z < layout.size.z; ++z)
      for (int y = -1; y < layout.size.y; ++y)
        for (int x = -1; x < layout.size.x; ++x) {
          const ivec3 cell(x, y, z);
          const auto planes = built.planes.at(cell);
          if (planes.empty()) continue;
          ASSERT_EQ(planes.size(), 1u);
          const float sign = glm::dot(planes[0].normal, n) < 0 ? -1.0f : 1.0f;
          EXPECT_NEAR(sign * glm::dot(planes[0].normal, n), 1, 1e-6);
          EXPECT_NEAR(sign * planes[0].offset, glm::dot(n, 2.0f * middle - centre(cell)), 1e-3);
          // Points of the cell are on the correct side.
          for (int k = 0; k < 4; ++k) {
            const vec3 point = centre(cell) + 0.5f * vec3(uniform(random), uniform(random), uniform(random));
            const float distance = glm::dot(n, point - 2.0f * middle);
            if (std::abs(distance) < 2e-3f) continue;
            EXPECT_EQ(sign * (glm::dot(planes[0].normal, point - centre(cell)) - planes[0].offset) > 0,
                      distance > 0);
          }
        }
  }
}

TEST(SurfacePlanes, EveryCellThatAWallCrossesHasItsPlane) {
  const GridLayout layout{{9, 9, 9}, 1, vec3(0)};
  std::vector<Triangle> wall;
  add_face(wall, {-20, 4.2f, -20}, {0, 0, 60}, {60, 0, 0});
  const Built built = build(wall, layout);
  EXPECT_EQ(built.planes.cell_count(), 100u);  // (9 + 1)^2, including the border.
  for (int z = -1; z < 9; ++z)
    for (int x = -1; x < 9; ++x) EXPECT_EQ(built.planes.at({x, 3, z}).size(), 1u);
  EXPECT_TRUE(built.planes.at({9, 3, 0}).empty());
  EXPECT_TRUE(built.planes.at({-2, 3, 0}).empty());
  EXPECT_TRUE(SurfacePlanes().at({0, 0, 0}).empty());
}

TEST(SurfacePlanes, ARoundColumnHasTangentPlanes) {
  const GridLayout layout{{24, 6, 24}, 0.5f, vec3(0)};
  constexpr float kRadius = 6;  // [voxels]
  constexpr int kFacets = 256;
  std::vector<Triangle> column;
  const auto rim = [](int i) {
    const float angle = 2 * std::numbers::pi_v<float> * static_cast<float>(i) / kFacets;
    return 0.5f * vec3(12.2f + kRadius * std::cos(angle), -10, 11.9f + kRadius * std::sin(angle));
  };
  for (int i = 0; i < kFacets; ++i) add_face(column, rim(i), rim(i + 1) - rim(i), {0, 20, 0});
  const Built built = build(column, layout);
  int cells = 0;
  for (int z = 0; z < 23; ++z)
    for (int x = 0; x < 23; ++x) {
      const ivec3 cell(x, 2, z);
      const auto planes = built.planes.at(cell);
      if (planes.empty()) continue;
      ++cells;
      ASSERT_EQ(planes.size(), 1u);
      // An arc in a cell is no longer than the cell's diagonal and a bit: its mean is within half of that
      // angle of the normal at any of its points, and within its sagitta of the circle.
      const float angle = 1.6f / kRadius, sagitta = kRadius * (1 - std::cos(angle / 2));
      const vec3 on_plane = centre(cell) + planes[0].offset * planes[0].normal;
      const vec3 radial = on_plane - vec3(12.2f, on_plane.y, 11.9f);
      EXPECT_GT(std::abs(glm::dot(glm::normalize(radial), planes[0].normal)), std::cos(angle));
      const float tangent = std::abs(glm::dot(planes[0].normal, radial));
      EXPECT_NEAR(tangent, kRadius, sagitta);
      EXPECT_NEAR(planes[0].normal.y, 0, 1e-5);
    }
  EXPECT_GT(cells, 30);
}

TEST(SurfacePlanes, ACornerHasAPlaneForEachWall) {
  const GridLayout layout{{8, 8, 8}, 1, vec3(0)};
  std::vector<Triangle> room;
  add_face(room, {3.9f, 0, 3.8f}, {0, 0, 4}, {0, 8, 0});
  add_face(room, {3.9f, 0, 3.8f}, {4, 0, 0}, {0, 8, 0});
  const Built two = build(room, layout);
  ASSERT_EQ(two.planes.at({3, 2, 3}).size(), 2u);
  EXPECT_NEAR(two.planes.at({3, 2, 3})[0].normal.x, 1, 1e-6);  // 0.7 long, the other 0.6.
  EXPECT_NEAR(two.planes.at({3, 2, 3})[0].offset, -0.1f, 1e-5);
  EXPECT_NEAR(two.planes.at({3, 2, 3})[1].normal.z, 1, 1e-6);
  EXPECT_NEAR(two.planes.at({3, 2, 3})[1].offset, -0.2f, 1e-5);
  EXPECT_EQ(two.planes.at({4, 2, 3}).size(), 1u);
  add_face(room, {3.9f, 3.7f, 3.8f}, {4, 0, 0}, {0, 0, 4});
  EXPECT_EQ(build(room, layout).planes.at({3, 3, 3}).size(), 3u);
}

TEST(SurfacePlanes, IsIndependentOfThreadsAndPartsMerge) {
  std::mt19937 random(5);
  std::uniform_real_distribution<float> place(-2, 18), step(-1.5f, 1.5f);
  std::vector<Triangle> soup(4000);
  for (Triangle& t : soup) {
    t.a = {place(random), place(random), place(random)};
    t.b = t.a + vec3(step(random), step(random), step(random));
    t.c = t.a + vec3(step(random), step(random), step(random));
  }
  const GridLayout layout{{16, 15, 17}, 1, vec3(0)};
  set_thread_count(1);
  const Built one = build(soup, layout);
  set_thread_count(4);
  const Built four = build(soup, layout);
  set_thread_count(0);
  EXPECT_EQ(one.planes, four.planes);

  const SurfacePlanes& planes = one.planes;
  std::vector<std::uint64_t> keys(planes.keys().begin(), planes.keys().end());
  std::vector<std::uint8_t> counts;
  for (std::size_t i = 0; i < keys.size(); ++i) counts.push_back(static_cast<std::uint8_t>(planes.count(i)));
  const std::vector<Plane> all(planes.planes().begin(), planes.planes().end());
  const auto again = SurfacePlanes::from_parts(layout.size, keys, counts, all);
  ASSERT_TRUE(again);
  EXPECT_EQ(*again, planes);
  for (const Plane& plane : all) {
    EXPECT_NEAR(glm::length(plane.normal), 1, 1e-5);
    EXPECT_LE(std::abs(plane.offset), 1);
  }

  auto wrong_keys = keys;
  std::swap(wrong_keys[0], wrong_keys[1]);
  EXPECT_FALSE(SurfacePlanes::from_parts(layout.size, wrong_keys, counts, all));
  wrong_keys = keys;
  wrong_keys.back() = 17 * 16 * 18;
  EXPECT_FALSE(SurfacePlanes::from_parts(layout.size, wrong_keys, counts, all));
  auto wrong_counts = counts;
  wrong_counts[3] = 0;
  EXPECT_FALSE(SurfacePlanes::from_parts(layout.size, keys, wrong_counts, all));
  auto wrong_planes = all;
  wrong_planes[5].normal.x = std::nanf("");
  EXPECT_FALSE(SurfacePlanes::from_parts(layout.size, keys, counts, wrong_planes));
}

// Each key's planes are found in its cell, and no planes in the cells beside it.
TEST(SurfacePlanes, AreFoundInEveryCell) {
  Random random(7);
  for (const ivec3 size : {ivec3(1), ivec3(7, 70, 131), ivec3(4096, 1, 4096), ivec3(33, 17, 5)}) {
    const glm::u64vec3 cells(size + 1);
    std::set<std::uint64_t> wanted{0, cells.x * cells.y * cells.z - 1};
    while (wanted.size() < std::min<std::uint64_t>(3000, cells.x * cells.y * cells.z / 2))
      wanted.insert(random() % (cells.x * cells.y * cells.z));
    const std::vector<std::uint64_t> keys(wanted.begin(), wanted.end());
    std::vector<std::uint8_t> counts;
    std::vector<Plane> planes;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      counts.push_back(static_cast<std::uint8_t>(1 + random() % kMaxPlanes));
      // Each plane is another one.
      for (int k = 0; k < counts.back(); ++k)
        planes.push_back({{0, 1, 0}, static_cast<float>(planes.size()) / 16384});
    }
    const auto made = SurfacePlanes::from_parts(size, keys, counts, planes);
    ASSERT_TRUE(made);
    std::size_t first = 0;
    for (std::size_t i = 0; i < keys.size(); ++i, first += counts[i - 1]) {
      const std::uint64_t key = keys[i];
      const ivec3 cell =
          ivec3(glm::u64vec3(key % cells.x, key / cells.x % cells.y, key / cells.x / cells.y)) - 1;
      const std::span<const Plane> found = made->at(cell);
      ASSERT_EQ(found.size(), counts[i]);
      EXPECT_EQ(found.data(), made->planes().data() + first);
      for (const std::uint64_t next : {key + 1, key + cells.x, key + cells.x * cells.y})
        if (!wanted.contains(next) && next < cells.x * cells.y * cells.z) {
          const glm::u64vec3 at(next % cells.x, next / cells.x % cells.y, next / cells.x / cells.y);
          EXPECT_TRUE(made->at(ivec3(at) - 1).empty());
        }
    }
    for (const ivec3 outside : {ivec3(-2, 0, 0), ivec3(0, size.y, 0), ivec3(0, 0, size.z + 7)})
      EXPECT_TRUE(made->at(outside).empty());
  }
}

}  // namespace
}  // namespace brume::voxel
