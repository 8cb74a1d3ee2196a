#include "voxel/traverse.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "tests/sanitized.hpp"
#include "tests/voxel/random.hpp"

namespace brume::voxel {
namespace {

using glm::ivec3;
using glm::vec3;

struct Ray {
  vec3 origin, direction;
  float t_max;
};

// Random, axis-parallel, diagonal through edges and corners, along faces; from inside, outside, and on faces.
Ray random_ray(Random& random, ivec3 size) {
  Ray ray;
  const bool on_lattice = random() % 3 == 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto reach = static_cast<float>(size[axis]);
    ray.origin[axis] = uniform(random, -1 - reach, 1 + 2 * reach);
    if (random() % 2) ray.origin[axis] = uniform(random, 0, reach);
    if (on_lattice) ray.origin[axis] = std::round(2 * ray.origin[axis]) / 2;
    ray.direction[axis] = uniform(random, -1, 1);
  }
  switch (random() % 6) {
    case 0: {  // along an axis
      const int axis = static_cast<int>(random() % 3);
      for (int other = 0; other < 3; ++other)
        if (other != axis) ray.direction[other] = random() % 2 ? 0.0f : -0.0f;
      break;
    }
    case 1:
      ray.direction[static_cast<int>(random() % 3)] = 0;
      break;
    case 2:  // diagonal
      for (int axis = 0; axis < 3; ++axis) ray.direction[axis] = static_cast<float>(random() % 3) - 1;
      break;
    case 3:  // grazing: nearly parallel
      ray.direction[static_cast<int>(random() % 3)] *= 1e-6f;
      break;
    default:
      break;
  }
  if (ray.direction == vec3(0)) ray.direction.x = 1;
  ray.t_max = random() % 3 ? std::numeric_limits<float>::infinity() : uniform(random, 0, 12);
  return ray;
}

struct Visit {
  ivec3 voxel;
  float enter, leave;
};

std::vector<Visit> walk(const GridLayout& layout, const Ray& ray) {
  std::vector<Visit> visits;
  visit_voxels(layout, ray.origin, ray.direction, ray.t_max, [&](ivec3 v, float enter, float leave) {
    visits.push_back({v, enter, leave});
    return true;
  });
  return visits;
}

// The t for which the ray is in [v, v + 1), by slabs. `Real` float: as the header of dda.h defines crossing,
// plane by plane; double: close to the exact result.
template <typename Real>
std::pair<Real, Real> interval_in(const Ray& ray, ivec3 v) {
  Real enter = 0, leave = static_cast<Real>(ray.t_max);
  for (int axis = 0; axis < 3; ++axis) {
    const Real o = ray.origin[axis], d = ray.direction[axis];
    if (d == 0) {
      if (o < static_cast<Real>(v[axis]) || o >= static_cast<Real>(v[axis] + 1)) leave = -1;
      continue;
    }
    const Real inverse = 1 / d;
    const Real a = (static_cast<Real>(v[axis]) - o) * inverse,
               b = (static_cast<Real>(v[axis] + 1) - o) * inverse;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  return {enter, leave};
}

template <typename Each>
void for_voxels(ivec3 size, Each each) {
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) each(ivec3(x, y, z));
}

TEST(VisitVoxels, MatchesBruteForceForAMillionRays) {
  Random random(1);
  const ivec3 sizes[] = {{1, 1, 1}, {5, 4, 3}, {9, 6, 4}, {7, 1, 2}};
  for (int i = 0; i < (kSanitized ? 100000 : 1000000); ++i) {
    const GridLayout layout{sizes[i % 4], 1, vec3(0)};
    const Ray ray = random_ray(random, layout.size);
    const std::vector<Visit> visits = walk(layout, ray);
    std::size_t expected = 0;
    for_voxels(layout.size, [&](ivec3 v) {
      const auto [enter, leave] = interval_in<float>(ray, v);
      if (!(enter < leave)) return;
      ++expected;
      const bool found =
          std::any_of(visits.begin(), visits.end(), [&, in = enter, out = leave](const Visit& visit) {
            return visit.voxel == v && visit.enter == in && visit.leave == out;
          });
      ASSERT_TRUE(found) << "ray " << i << " misses " << v.x << " " << v.y << " " << v.z;
    });
    ASSERT_EQ(visits.size(), expected) << "ray " << i;
    for (std::size_t k = 1; k < visits.size(); ++k) ASSERT_EQ(visits[k].enter, visits[k - 1].leave);
  }
}

TEST(VisitVoxels, MatchesDoublePrecisionUpToRounding) {
  // A plane's t has three roundings of 2^-24: difference, inverse, product.
  Random random(2);
  const GridLayout layout{{6, 5, 7}, 1, vec3(0)};
  for (int i = 0; i < (kSanitized ? 10000 : 100000); ++i) {
    const Ray ray = random_ray(random, layout.size);
    const std::vector<Visit> visits = walk(layout, ray);
    for_voxels(layout.size, [&](ivec3 v) {
      const auto [enter, leave] = interval_in<double>(ray, v);
      const double rounding = 2 * 3 * 0x1p-24 * (std::abs(enter) + (leave < 1e30 ? std::abs(leave) : 0));
      const bool visited =
          std::any_of(visits.begin(), visits.end(), [&](const Visit& o) { return o.voxel == v; });
      ASSERT_TRUE(visited || !(enter + rounding < leave)) << "ray " << i;
      ASSERT_TRUE(!visited || !(enter > leave + rounding)) << "ray " << i;
    });
  }
}

TEST(VisitVoxels, TiesGoThroughTheCornerAndUpwardsOnAFace) {
  const GridLayout layout{{4, 4, 4}, 1, vec3(0)};
  const auto diagonal = walk(layout, {vec3(0), vec3(1), 100});
  ASSERT_EQ(diagonal.size(), 4u);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(diagonal[static_cast<std::size_t>(i)].voxel, ivec3(i));
  const auto backwards = walk(layout, {vec3(4), vec3(-1), 100});
  ASSERT_EQ(backwards.size(), 4u);
  EXPECT_EQ(backwards[0].voxel, ivec3(3));
  const auto on_face = walk(layout, {{-1, 2, 1.5f}, {1, 0, 0}, 100});
  ASSERT_EQ(on_face.size(), 4u);
  EXPECT_EQ(on_face[0].voxel, ivec3(0, 2, 1));
  EXPECT_TRUE(walk(layout, {{-1, 4, 1.5f}, {1, 0, 0}, 100}).empty());
}

TEST(VisitVoxels, StopsOnRequestAndIgnoresInvalidRays) {
  const GridLayout layout{{4, 4, 4}, 1, vec3(0)};
  int count = 0;
  visit_voxels(layout, vec3(0.5f), vec3(1, 0, 0), 100, [&](ivec3, float, float) { return ++count < 2; });
  EXPECT_EQ(count, 2);
  EXPECT_TRUE(walk(layout, {vec3(0.5f), vec3(0), 100}).empty());
  EXPECT_TRUE(walk(layout, {vec3(std::nanf("")), vec3(1), 100}).empty());
  EXPECT_TRUE(walk(layout, {vec3(0.5f), vec3(std::numeric_limits<float>::infinity(), 0, 0), 100}).empty());
  EXPECT_TRUE(walk(layout, {vec3(0.5f), vec3(1, 0, 0), std::nanf("")}).empty());
  EXPECT_EQ(walk(layout, {vec3(0.5f), vec3(1e-38f, 0, 0), std::numeric_limits<float>::infinity()}).size(),
            4u);
  walk(layout, {vec3(3e38f, -3e38f, 0), vec3(-3e38f, 3e38f, 1e-45f), 100});
}

TEST(FirstSolid, MatchesTheFirstSolidVoxelOfTheTraversal) {
  Random random(3);
  const ivec3 sizes[] = {{33, 17, 5}, {64, 64, 64}, {7, 9, 70}};
  for (int scene = 0; scene < 12; ++scene) {
    const GridLayout layout{sizes[scene % 3], 1, vec3(0)};
    BitGrid grid(layout);
    const auto solids = static_cast<int>(random() % 200);
    for (int i = 0; i < solids; ++i) {
      const auto at = [&](int axis) {
        return static_cast<int>(random() % static_cast<std::uint64_t>(layout.size[axis]));
      };
      grid.set({at(0), at(1), at(2)}, true);
    }
    for (int i = 0; i < 5000; ++i) {
      const Ray ray = random_ray(random, layout.size);
      std::optional<Visit> expected;
      visit_voxels(layout, ray.origin, ray.direction, ray.t_max, [&](ivec3 v, float enter, float leave) {
        if (grid.solid(v)) expected = Visit{v, enter, leave};
        return !expected;
      });
      const auto hit = first_solid(grid, ray.origin, ray.direction, ray.t_max);
      ASSERT_EQ(hit.has_value(), expected.has_value()) << "ray " << i;
      if (!hit) continue;
      ASSERT_EQ(hit->voxel, expected->voxel) << "ray " << i;
      ASSERT_EQ(hit->t, expected->enter) << "ray " << i;
      ASSERT_LE(glm::dot(vec3(hit->normal), ray.direction), 0.0f);
      ASSERT_TRUE(hit->normal != ivec3(0) || hit->t == 0);
    }
  }
}

TEST(FirstSolid, NamesTheFaceThatTheRayEnters) {
  BitGrid grid({{40, 40, 40}, 1, vec3(0)});
  grid.set({20, 20, 20}, true);
  for (int axis = 0; axis < 3; ++axis)
    for (const int side : {-1, 1}) {
      vec3 origin(20.5f), direction(0);
      origin[axis] += 50.0f * static_cast<float>(side);
      direction[axis] = static_cast<float>(-side);
      const auto hit = first_solid(grid, origin, direction);
      ASSERT_TRUE(hit);
      ivec3 normal(0);
      normal[axis] = side;
      EXPECT_EQ(hit->normal, normal);
      EXPECT_EQ(hit->t, 49.5f);
    }
  EXPECT_EQ(first_solid(grid, vec3(20.5f), vec3(1, 0, 0))->normal, ivec3(0));
  EXPECT_FALSE(first_solid(grid, {0, 20.5f, 20.5f}, {1, 0, 0}, 20));
  EXPECT_TRUE(first_solid(grid, {0, 20.5f, 20.5f}, {1, 0, 0}, 20.01f));
}

}  // namespace
}  // namespace brume::voxel
