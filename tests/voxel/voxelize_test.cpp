#include "voxel/voxelize.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/tasks.hpp"
#include "tests/reference/triangle_box.hpp"
#include "tests/sanitized.hpp"
#include "tests/voxel/random.hpp"

namespace brume::voxel {
namespace {

using glm::ivec3;
using glm::vec3;

// A random corner: anywhere, or on multiples of a step, sometimes outside of the grid.
vec3 random_corner(Random& random, const GridLayout& layout, float step) {
  vec3 p;
  for (int axis = 0; axis < 3; ++axis) {
    const float reach = static_cast<float>(layout.size[axis]);
    p[axis] = uniform(random, -0.4f * reach, 1.4f * reach);
    if (step > 0) p[axis] = std::round(p[axis] / step) * step;
  }
  return world_from_voxel(layout, p);
}

// A triangle of one of the shapes that voxelizers get wrong.
Triangle random_triangle(Random& random, const GridLayout& layout) {
  const float steps[] = {0, 0, 1, 0.5f, 0.25f};
  const float step = steps[random() % 5];
  Triangle t{random_corner(random, layout, step), random_corner(random, layout, step),
             random_corner(random, layout, step)};
  switch (random() % 8) {
    case 0:
      t.c = t.b;
      break;  // a segment
    case 1:
      t.b = t.c = t.a;
      break;  // a point
    case 2:
      t.c = 0.5f * (t.a + t.b);
      break;   // three corners in line
    case 3: {  // in a plane of the grid's
      const int axis = static_cast<int>(random() % 3);
      t.b[axis] = t.c[axis] = t.a[axis];
      break;
    }
    case 4: {  // small
      t.b = t.a + 0.05f * (t.b - t.a);
      t.c = t.a + 0.05f * (t.c - t.a);
      break;
    }
    case 5: {  // a segment along an axis
      const int axis = static_cast<int>(random() % 3);
      const float end = t.b[axis];
      t.b = t.c = t.a;
      t.b[axis] = end;
      break;
    }
    default:
      break;
  }
  return t;
}

// Where the voxel size is a power of two, doubles hold every product of coordinates on a grid and the
// reference is exact. Elsewhere coordinates are quotients, and the reference has rounding errors.
void expect_equal(const std::vector<Triangle>& triangles, const GridLayout& layout, std::size_t soup) {
  const auto grid = voxelize(triangles, layout);
  ASSERT_TRUE(grid);
  const double slack = layout.voxel_size == 0.5f || layout.voxel_size == 1 ? 0 : 1;
  const std::vector<bool> must = reference::brute_force_voxels(triangles, layout, -slack);
  const std::vector<bool> may = reference::brute_force_voxels(triangles, layout, slack);
  std::size_t i = 0;
  for (int z = 0; z < layout.size.z; ++z)
    for (int y = 0; y < layout.size.y; ++y)
      for (int x = 0; x < layout.size.x; ++x, ++i) {
        const bool solid = grid->solid({x, y, z});
        ASSERT_TRUE(solid ? may[i] : !must[i])
            << (solid ? "extra" : "missed") << " in soup " << soup << ": " << x << " " << y << " " << z;
      }
}

TEST(Voxelize, MatchesBruteForceOn200TriangleSoups) {
  Random random(7);
  const ivec3 sizes[] = {{1, 1, 1}, {7, 7, 7}, {33, 17, 5}, {2, 19, 11}, {16, 16, 16}};
  const float voxel_sizes[] = {0.5f, 0.1f, 1.0f, 0.37f};
  for (std::size_t soup = 0; soup < 200; soup += kSanitized ? 7 : 1) {
    GridLayout layout{sizes[soup % 5], voxel_sizes[soup / 5 % 4], vec3(0)};
    if (soup % 2) layout.origin_world = vec3(uniform(random, -9, 9), -30, uniform(random, -9, 9));
    std::vector<Triangle> triangles(1 + random() % 12);
    for (Triangle& t : triangles) t = random_triangle(random, layout);
    // Single shapes first: in a full grid one could mask the error of another.
    if (soup % 3 == 0) triangles.resize(1);
    ASSERT_NO_FATAL_FAILURE(expect_equal(triangles, layout, soup));
  }
}

TEST(Voxelize, EachShapeMatchesBruteForce) {
  Random random(8);
  for (std::size_t i = 0; i < (kSanitized ? 300 : 3000); ++i) {
    const GridLayout layout{{9, 6, 7}, i % 2 ? 0.5f : 0.3f, vec3(i % 2 ? -30.0f : 0.7f)};
    const std::vector<Triangle> one{random_triangle(random, layout)};
    ASSERT_NO_FATAL_FAILURE(expect_equal(one, layout, i));
  }
}

TEST(Voxelize, TouchingCountsOnBothSides) {
  // A square exactly between voxels 3 and 4, its rim on the borders of voxels too.
  const GridLayout layout{{8, 8, 8}, 0.5f, vec3(-1)};
  const vec3 a = world_from_voxel(layout, {4, 2, 2}), b = world_from_voxel(layout, {4, 5, 2}),
             c = world_from_voxel(layout, {4, 5, 5}), d = world_from_voxel(layout, {4, 2, 5});
  const auto grid = voxelize(std::vector<Triangle>{{a, b, c}, {a, c, d}}, layout);
  ASSERT_TRUE(grid);
  for (int z = 0; z < 8; ++z)
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x)
        EXPECT_EQ(grid->solid({x, y, z}), (x == 3 || x == 4) && y >= 1 && y <= 5 && z >= 1 && z <= 5);
}

TEST(Voxelize, APointOnACornerTouchesEightVoxels) {
  const GridLayout layout{{4, 4, 4}, 1, vec3(0)};
  const auto grid = voxelize(std::vector<Triangle>{{vec3(2), vec3(2), vec3(2)}}, layout);
  ASSERT_TRUE(grid);
  EXPECT_EQ(grid->count_solid(), 8u);
}

TEST(Voxelize, IsIndependentOfTheNumberOfThreads) {
  Random random(9);
  const GridLayout layout{{65, 33, 70}, 0.25f, vec3(-3)};
  std::vector<Triangle> triangles(5000);
  for (Triangle& t : triangles) {
    t.a = random_corner(random, layout, 0);
    t.b = t.a + vec3(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
    t.c = t.a + vec3(uniform(random, -1, 1), uniform(random, -1, 1), uniform(random, -1, 1));
  }
  set_thread_count(1);
  const auto one = voxelize(triangles, layout);
  set_thread_count(5);
  const auto five = voxelize(triangles, layout);
  set_thread_count(0);
  ASSERT_TRUE(one && five);
  EXPECT_EQ(one->count_solid(), five->count_solid());
  one->for_each_brick([&](ivec3 at, const BitGrid::Brick& brick) {
    ASSERT_NE(five->find_brick(at), nullptr);
    EXPECT_EQ(*five->find_brick(at), brick);
  });
}

TEST(Voxelize, TranslationByWholeVoxelsMovesTheVoxels) {
  Random random(10);
  const GridLayout layout{{20, 20, 20}, 0.5f, vec3(0)};
  GridLayout moved = layout;
  moved.origin_world += 0.5f * vec3(3, -2, 1);
  std::vector<Triangle> triangles(40);
  for (Triangle& t : triangles)
    for (vec3* p : {&t.a, &t.b, &t.c}) *p = vec3(ivec3(random_corner(random, layout, 0) * 64.0f)) / 64.0f;
  const auto here = voxelize(triangles, layout), there = voxelize(triangles, moved);
  ASSERT_TRUE(here && there);
  for (int z = 0; z < 20; ++z)
    for (int y = 0; y < 20; ++y)
      for (int x = 0; x < 20; ++x) {
        const ivec3 v(x, y, z), w = v - ivec3(3, -2, 1);
        if (there->contains(w)) {
          EXPECT_EQ(here->solid(v), there->solid(w));
        }
      }
}

TEST(Voxelize, AGridOf4096PerAxisStaysSparse) {
  // A floor through the whole grid, a diagonal needle from corner to corner.
  const GridLayout layout{{4096, 4096, 4096}, 1, vec3(0)};
  const float end = 4096;
  const auto grid = voxelize(std::vector<Triangle>{{{0, 7.5f, 0}, {end, 7.5f, 0}, {0, 7.5f, 512}},
                                                   {vec3(0.5f), vec3(end - 0.5f), vec3(2048)}},
                             layout);
  ASSERT_TRUE(grid);
  EXPECT_LT(grid->bytes(), 64u << 20);
  for (int i = 0; i < 4096; i += 5) EXPECT_TRUE(grid->solid(ivec3(i)));
  EXPECT_TRUE(grid->solid({4090, 7, 0}));
  EXPECT_FALSE(grid->solid({4090, 7, 2}));
}

TEST(Voxelize, HostileCornersAreHarmless) {
  const GridLayout layout{{8, 8, 8}, std::numeric_limits<float>::denorm_min(), vec3(0)};
  const float huge = std::numeric_limits<float>::max(), inf = std::numeric_limits<float>::infinity();
  const std::vector<Triangle> triangles{{{-huge, -huge, -huge}, {huge, -huge, huge}, {huge, huge, -huge}},
                                        {vec3(inf), vec3(0), vec3(1)},
                                        {vec3(std::nanf("")), vec3(0), vec3(1)},
                                        {vec3(-huge), vec3(huge), vec3(0)}};
  EXPECT_TRUE(voxelize(triangles, layout));
  // Distant corners: the plane x + y + z = 0 still runs through the grid's first voxel.
  const float far = 1e16f;
  const auto plane = voxelize(std::vector<Triangle>{{{far, -far, 0}, {0, far, -far}, {-far, 0, far}}},
                              {{8, 8, 8}, 1, vec3(0)});
  ASSERT_TRUE(plane);
  EXPECT_TRUE(plane->solid({0, 0, 0}));
  EXPECT_EQ(plane->count_solid(), 1u);
  const auto none = voxelize(std::vector<Triangle>{{vec3(inf), vec3(0), vec3(1)}}, {{8, 8, 8}, 1, vec3(0)});
  ASSERT_TRUE(none);
  EXPECT_EQ(none->count_solid(), 0u);
}

TEST(Voxelize, RejectsInvalidLayouts) {
  const auto code = [](ivec3 size, float voxel_size) {
    const auto grid = voxelize({}, {size, voxel_size, vec3(0)});
    return grid ? ErrorCode{} : grid.failure().code;
  };
  EXPECT_EQ(code({0, 8, 8}, 1), ErrorCode::usage);
  EXPECT_EQ(code({8, -1, 8}, 1), ErrorCode::usage);
  EXPECT_EQ(code({8, 8, 1000000}, 1), ErrorCode::resource_limit);
  EXPECT_EQ(code({8, 8, 8}, 0), ErrorCode::usage);
  EXPECT_EQ(code({8, 8, 8}, -1), ErrorCode::usage);
  EXPECT_EQ(code({8, 8, 8}, std::nanf("")), ErrorCode::usage);
  const auto failed = voxelize({}, {{8, 8, 1000000}, 1, vec3(0)});
  EXPECT_NE(failed.failure().message.find("4096"), std::string::npos);
  EXPECT_EQ(failed.failure().message.find('\n'), std::string::npos);
}

TEST(LayoutAround, ContainsTheBoundsAndAMargin) {
  const auto layout = layout_around({-1.2f, 0, 3.1f}, {2.6f, 0, 4.9f}, 0.5f, 2);
  ASSERT_TRUE(layout);
  EXPECT_EQ(layout->size, ivec3(9 + 4, 1 * 0 + 4, 4 + 4));
  EXPECT_EQ(layout->origin_world, vec3(-2.5f, -1.0f, 2.0f));
  EXPECT_EQ(layout_around(vec3(1), vec3(0), 0.5f, 2).failure().code, ErrorCode::bad_input);
  EXPECT_EQ(layout_around(vec3(-1e30f), vec3(1e30f), 0.5f, 2).failure().code, ErrorCode::resource_limit);
  EXPECT_EQ(layout_around(vec3(0), vec3(1), 0, 2).failure().code, ErrorCode::usage);
  EXPECT_EQ(layout_around(vec3(0), vec3(1), 1, -2).failure().code, ErrorCode::usage);
}

}  // namespace
}  // namespace brume::voxel
