#include "bake/mean_winding.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>

#include "core/tasks.hpp"
#include "tests/bake/meshes.hpp"
#include "tests/reference/voxel_volume.hpp"
#include "tests/sanitized.hpp"
#include "tests/voxel/random.hpp"

namespace brume::bake {
namespace {

using glm::dvec3;
using glm::uvec3;
using glm::vec3;
using voxel::Random;
using voxel::uniform;

// Coordinates of n voxels have an error of about 3 n 2^-53 voxels. Moving a surface by e changes a voxel's
// fraction by e times the surface's area in it, a few units, and the sum along z adds 2^-53 for each piece in
// the column. For n <= 64 and some hundred pieces that is below 1e-13.
constexpr double kRoundingBound = 1e-12;

std::size_t index_of(uvec3 size, uvec3 v) {
  return v.x + std::size_t{size.x} * (v.y + std::size_t{size.y} * v.z);
}

template <typename Visit>
void for_each_voxel(uvec3 size, Visit visit) {
  for (unsigned z = 0; z < size.z; ++z)
    for (unsigned y = 0; y < size.y; ++y)
      for (unsigned x = 0; x < size.x; ++x) visit(uvec3(x, y, z));
}

double volume_of(const MeanWinding& mean, const Box<double>& box) {
  const dvec3 extent = box.high - box.low;
  return std::accumulate(mean.values.begin(), mean.values.end(), 0.0) * extent.x * extent.y * extent.z /
         static_cast<double>(mean.values.size());
}

vec3 random_point(Random& random, double low, double high) {
  const auto from = static_cast<float>(low), to = static_cast<float>(high);
  const float x = uniform(random, from, to), y = uniform(random, from, to);
  return {x, y, uniform(random, from, to)};
}

void expect_reference(const Mesh& mesh, const Box<double>& box, uvec3 size) {
  const MeanWinding mean = mean_winding(mesh, box, size);
  for_each_voxel(size, [&](uvec3 v) {
    ASSERT_NEAR(mean.values[index_of(size, v)], reference::voxel_fraction(mesh, box, size, v), kRoundingBound)
        << v.x << " " << v.y << " " << v.z;
  });
}

TEST(MeanWinding, AxisAlignedBoxesAreProductsOfOverlaps) {
  Random random(1);
  const uvec3 sizes[] = {{7, 5, 6}, {1, 1, 1}, {64, 1, 3}, {1, 9, 2}, {2, 3, 70}, {3, 130, 2}};
  for (int round = 0; round < 60; ++round) {
    const uvec3 size = sizes[round % 6];
    const Box<double> box{dvec3(-1.37, 0.21, -0.77), dvec3(2.11, 3.9, 1.03)};
    // In the box, cut by it, around it, or beside it.
    const vec3 p = random_point(random, -3, 5), q = random_point(random, -3, 5);
    const vec3 low = glm::min(p, q), high = glm::max(p, q);
    const MeanWinding mean = mean_winding(box_mesh(low, high), box, size);
    const dvec3 edge = (box.high - box.low) / dvec3(size);
    for_each_voxel(size, [&](uvec3 v) {
      const dvec3 from = box.low + dvec3(v) * edge, to = from + edge;
      const dvec3 overlap = glm::max(dvec3(0), glm::min(to, dvec3(high)) - glm::max(from, dvec3(low))) / edge;
      ASSERT_NEAR(mean.values[index_of(size, v)], overlap.x * overlap.y * overlap.z, kRoundingBound)
          << round << ": " << v.x << " " << v.y << " " << v.z;
    });
  }
}

TEST(MeanWinding, RotatedBoxesMatchTheReference) {
  Random random(2);
  for (int round = 0; round < (kSanitized ? 2 : 8); ++round) {
    const dvec3 x = glm::normalize(dvec3(random_point(random, -1, 1)));
    const dvec3 y = glm::normalize(glm::cross(x, dvec3(random_point(random, -1, 1))));
    const dvec3 z = glm::cross(x, y);
    Mesh mesh = parallelepiped({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
    const auto place = [&](vec3& p) {
      p = vec3(dvec3(0.1, -0.2, 0.3) + 1.3 * (p.x - 0.5) * x + 0.7 * (p.y - 0.5) * y + 0.4 * (p.z - 0.5) * z);
    };
    for (voxel::Triangle& t : mesh) place(t.a), place(t.b), place(t.c);
    // All of it in the box, and cut by the box.
    const Box<double> around{dvec3(-1), dvec3(1.2)};
    expect_reference(mesh, around, {6, 5, 7});
    expect_reference(mesh, {dvec3(-0.3, -0.4, -0.1), dvec3(0.4, 0.5, 0.6)}, {3, 4, 3});
    const double volume = signed_volume(mesh);
    EXPECT_NEAR(volume_of(mean_winding(mesh, around, {6, 5, 7}), around), volume, 1e-12 * volume);
  }
}

TEST(MeanWinding, TetrahedraMatchTheReference) {
  Random random(3);
  for (int round = 0; round < (kSanitized ? 4 : 30); ++round) {
    // Every third has its corners on planes between voxels.
    const auto corner = [&] {
      const vec3 p = random_point(random, -2, 2);
      return round % 3 ? p : glm::round(2.0f * p) / 2.0f;
    };
    const vec3 a = corner(), b = corner(), c = corner(), d = corner();
    Mesh mesh{{a, c, b}, {a, b, d}, {b, c, d}, {c, a, d}};
    const Box<double> box{dvec3(-2), dvec3(2)};
    expect_reference(mesh, box, {8, 8, 4});
    const double volume = signed_volume(mesh);
    // Relative to the box where the tetrahedron is nearly flat.
    EXPECT_NEAR(volume_of(mean_winding(mesh, box, {8, 8, 8}), box), volume,
                1e-12 * std::max(1.0, std::abs(volume)));
  }
}

// The volume below z of a ball around the origin.
double ball_below(double radius, double z) {
  z = std::clamp(z, -radius, radius);
  return std::numbers::pi * (radius * radius * (z + radius) - (z * z * z + radius * radius * radius) / 3);
}

TEST(MeanWinding, SlabsOfASphereLieBetweenThoseOfTwoBalls) {
  const uvec3 size(32);
  const Box<double> box{dvec3(-1.1), dvec3(1.1)};
  const double edge = 2.2 / 32;
  double last_deficit = 0;
  for (const int segments : {24, 48, 96}) {
    const Mesh mesh = sphere_mesh(dvec3(0), 1, segments, segments / 2);
    // A point of a triangle with corners on the unit sphere is sum(w_i p_i), its distance from the middle
    // squared 1 - sum(w_i w_k |p_i - p_k|^2) over pairs >= 1 - longest^2 / 3. Corners are off by 2^-24.
    double longest = 0;
    for (const voxel::Triangle& t : mesh)
      for (const vec3 side : {t.b - t.a, t.c - t.b, t.a - t.c})
        longest = std::max(longest, double{glm::length(side)});
    const double inner = std::sqrt(1 - longest * longest / 3) - 1e-6, outer = 1 + 1e-6;

    const MeanWinding mean = mean_winding(mesh, box, size);
    for (unsigned z = 0; z < size.z; ++z) {
      double slab = 0;
      for (std::size_t i = 0; i < 32 * 32; ++i) slab += mean.values[z * 32 * 32 + i];
      slab *= edge * edge * edge;
      const double from = box.low.z + z * edge, to = from + edge;
      EXPECT_GE(slab, ball_below(inner, to) - ball_below(inner, from) - 1e-12) << z;
      EXPECT_LE(slab, ball_below(outer, to) - ball_below(outer, from) + 1e-12) << z;
    }

    // The deficit falls with the square of the edges; the next term is smaller by about (pi / segments)^2.
    const double volume = volume_of(mean, box), deficit = ball_below(1, 1) - volume;
    EXPECT_NEAR(volume, signed_volume(mesh), 1e-12 * volume);
    if (last_deficit > 0) {
      EXPECT_NEAR(last_deficit / deficit, 4, 0.1);
    }
    last_deficit = deficit;
  }
}

TEST(MeanWinding, ATorusConvergesToItsAnalyticVolume) {
  const double major = 0.7, minor = 0.3, exact = 2 * std::pow(std::numbers::pi, 2) * major * minor * minor;
  const Box<double> box{dvec3(-1.05, -1.05, -0.4), dvec3(1.05, 1.05, 0.4)};
  double last_error = 0;
  for (const int segments : {16, 32, 64}) {
    const Mesh mesh = torus_mesh(major, minor, segments, segments);
    const MeanWinding mean = mean_winding(mesh, box, {33, 31, 12});
    const double volume = volume_of(mean, box);
    EXPECT_NEAR(volume, signed_volume(mesh), 1e-12 * volume);
    // As for the sphere.
    if (last_error > 0) {
      EXPECT_NEAR(last_error / (exact - volume), 4, 0.2);
    }
    last_error = exact - volume;
  }
}

// The mean absolute difference from a solid that spans |z| <= height(x, y), which 8 x 8 lines through each
// column integrate.
double mean_error(const MeanWinding& mean, const Box<double>& box, uvec3 size,
                  const std::function<double(double, double)>& height) {
  const dvec3 edge = (box.high - box.low) / dvec3(size);
  double error = 0;
  std::vector<double> column(size.z);
  for (unsigned y = 0; y < size.y; ++y)
    for (unsigned x = 0; x < size.x; ++x) {
      column.assign(size.z, 0);
      for (unsigned line = 0; line < 64; ++line) {
        const double at_x = box.low.x + (x + (line % 8 + 0.5) / 8) * edge.x;
        const double at_y = box.low.y + (y + (line / 8 + 0.5) / 8) * edge.y;
        const double top = height(at_x, at_y);
        if (!(top > 0)) continue;
        for (unsigned z = 0; z < size.z; ++z) {
          const double low = box.low.z + z * edge.z;
          column[z] += std::max(0.0, std::min(low + edge.z, top) - std::max(low, -top)) / edge.z / 64;
        }
      }
      for (unsigned z = 0; z < size.z; ++z)
        error += std::abs(mean.values[index_of(size, {x, y, z})] - column[z]);
    }
  return error / static_cast<double>(mean.values.size());
}

TEST(MeanWinding, VoxelsOfFineMeshesAreThoseOfTheirSolids) {
  const uvec3 size(64);
  const Box<double> box{dvec3(-1.1), dvec3(1.1)};
  const auto ball = [](double x, double y) { return std::sqrt(std::max(0.0, 1 - x * x - y * y)); };
  const auto ring = [](double x, double y) {
    const double from_ring = std::hypot(x, y) - 0.7;
    return std::sqrt(std::max(0.0, 0.09 - from_ring * from_ring));
  };
  // The sphere's radius is 29 voxels. Edges of its mesh, and segments of its rings, lie up to
  // 29 (1 - cos(pi / 96)) = 0.016 voxels below it each, together 0.03 at most, times its area of 4 pi 29^2
  // voxels: 0.0013 per voxel. The lines place the border within 1/16 voxel at 5 % of the voxels, to either
  // side. The torus has less area.
  EXPECT_LT(mean_error(mean_winding(sphere_mesh(dvec3(0), 1, 96, 48), box, size), box, size, ball), 0.002);
  EXPECT_LT(mean_error(mean_winding(torus_mesh(0.7, 0.3, 96, 48), box, size), box, size, ring), 0.002);
}

TEST(MeanWinding, SolidsAddUpWithTheSignOfTheirOrientation) {
  const Box<double> box{dvec3(-3), dvec3(3)};
  const uvec3 size(13, 11, 12);
  const Mesh a = sphere_mesh(dvec3(-0.4, 0.1, 0.2), 1.7, 20, 10), b = sphere_mesh(dvec3(0.6, 0, 0), 1, 16, 8);
  const MeanWinding of_a = mean_winding(a, box, size), of_b = mean_winding(b, box, size);
  const MeanWinding sum = mean_winding(joined(a, b), box, size);
  const MeanWinding difference = mean_winding(joined(a, inverted(b)), box, size);
  for (std::size_t i = 0; i < sum.values.size(); ++i) {
    EXPECT_NEAR(sum.values[i], of_a.values[i] + of_b.values[i], kRoundingBound);
    EXPECT_NEAR(difference.values[i], of_a.values[i] - of_b.values[i], kRoundingBound);
  }
}

TEST(MeanWinding, UncrossedVoxelsAreEmptyOrFull) {
  const MeanWinding mean =
      mean_winding(sphere_mesh(dvec3(0.1), 1, 40, 20), {dvec3(-1.3), dvec3(1.3)}, uvec3(20));
  std::size_t crossed = 0;
  for (std::size_t i = 0; i < mean.values.size(); ++i) {
    crossed += mean.crossed[i];
    if (mean.crossed[i] == 0) {
      EXPECT_NEAR(mean.values[i], std::round(mean.values[i]), kRoundingBound);
    } else {
      EXPECT_TRUE(mean.values[i] > -kRoundingBound && mean.values[i] < 1 + kRoundingBound);
    }
  }
  EXPECT_GT(crossed, 0u);
  EXPECT_LT(crossed, mean.values.size() / 2);
}

TEST(MeanWinding, MeshesFarLargerThanTheBoxFillIt) {
  const Box<double> box{dvec3(-0.3, 0.1, -0.2), dvec3(0.5, 0.4, 0.6)};
  for (const float half : {1e2f, 1e6f}) {
    const MeanWinding mean = mean_winding(box_mesh(vec3(-half), vec3(half)), box, {9, 8, 7});
    // As kRoundingBound, for n = half / 0.03.
    for (const double value : mean.values) EXPECT_NEAR(value, 1, 3 * 40 * half * 0x1p-53 + kRoundingBound);
  }
  const MeanWinding beside = mean_winding(box_mesh(vec3(1e6f), vec3(2e6f)), box, {9, 8, 7});
  for (const double value : beside.values) EXPECT_EQ(value, 0);
}

TEST(MeanWinding, HostileCornersDoNoHarm) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  const float values[] = {0, 1, -1, 0.5f, 1e30f, -1e30f, 3.4e38f, -3.4e38f, nan, inf, -inf, 1e-40f};
  Random random(4);
  for (int round = 0; round < 200; ++round) {
    const auto corner = [&] {
      return vec3(values[random() % 12], values[random() % 12], values[random() % 12]);
    };
    Mesh mesh;
    for (int i = 0; i < 20; ++i) mesh.push_back({corner(), corner(), corner()});
    const uvec3 size = round % 2 ? uvec3(1) : uvec3(5, 3, 4);
    const Box<double> box{dvec3(-1), round % 3 ? dvec3(1) : dvec3(1, -1 + 1e-9, 1)};
    for (const double value : mean_winding(mesh, box, size).values) EXPECT_TRUE(std::isfinite(value));
  }
}

TEST(MeanWinding, IsTheSameForAnyNumberOfThreads) {
  const Mesh mesh = torus_mesh(0.7, 0.3, 50, 30);
  const Box<double> box{dvec3(-1.05), dvec3(0.9)};
  set_thread_count(1);
  const MeanWinding one = mean_winding(mesh, box, {17, 70, 9});
  set_thread_count(4);
  const MeanWinding four = mean_winding(mesh, box, {17, 70, 9});
  set_thread_count(0);
  EXPECT_EQ(one.values, four.values);
  EXPECT_EQ(one.crossed, four.crossed);
}

}  // namespace
}  // namespace brume::bake
