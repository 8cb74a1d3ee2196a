#include "grids/generate.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <numbers>
#include <random>

#include "core/tasks.hpp"
#include "tests/reference/cloud.hpp"
#include "tests/sanitized.hpp"

namespace brume::grids {
namespace {

constexpr std::array kKinds{CloudKind::pyroclastic, CloudKind::sphere, CloudKind::slab, CloudKind::torus};

/// A shape that fills most of a small cube.
CloudSettings small(CloudKind kind, std::uint32_t edge) {
  CloudSettings settings;
  settings.kind = kind;
  settings.edge = edge;
  settings.voxel_size = 0.25;
  settings.radius = 0.3 * edge * settings.voxel_size;
  settings.edge_width = 0.5;
  settings.seed = 3;
  return settings;
}

float value_of(const Grid& grid, std::size_t brick, std::size_t voxel) {
  float value = 0;
  std::memcpy(&value, grid.values_of(brick).data() + voxel * sizeof value, sizeof value);
  return value;
}

double sum_of(const Grid& grid) {
  double sum = 0;
  for (std::size_t brick = 0; brick < grid.bricks.size(); ++brick)
    for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) sum += double{value_of(grid, brick, voxel)};
  return sum;
}

TEST(GenerateCloud, HoldsExactlyTheVoxelsAboveZero) {
  for (const CloudKind kind : kKinds)
    for (const std::uint32_t edge : {1u, 7u, 8u, 33u})
      for (const double edge_width : {0.0, 0.5}) {
        CloudSettings settings = small(kind, edge);
        settings.edge_width = edge_width;
        const Grid grid = generate_cloud(settings);
        const shared::CloudParams params = cloud_params(settings);
        std::uint64_t active = 0;
        const int bricks = (static_cast<int>(edge) + 7) / 8;
        for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(8 * bricks)}, [&](glm::ivec3 at) {
          const float expected = shared::cloud_voxel(params, at);
          const auto brick = find_brick(grid, at / 8 * 8);
          const glm::ivec3 in = at % 8;
          const auto voxel = static_cast<std::size_t>(in.x + 8 * (in.y + 8 * in.z));
          ASSERT_EQ(brick ? value_of(grid, *brick, voxel) : 0.0f, expected)
              << at.x << " " << at.y << " " << at.z;
          ASSERT_EQ(brick && grid.bricks[*brick].is_active(voxel), expected > 0);
          active += expected > 0;
        });
        EXPECT_EQ(count_active(grid), active) << "kind " << int(kind) << " edge " << edge;
        EXPECT_EQ(active > 0, edge > 1 || kind != CloudKind::torus) << "its middle is a hole";
        EXPECT_TRUE(std::ranges::is_sorted(grid.bricks, goes_before, &Brick::origin));
        for (const Brick& brick : grid.bricks)
          EXPECT_TRUE(std::ranges::any_of(brick.active, [](std::uint64_t word) { return word != 0; }));
      }
}

TEST(GenerateCloud, EqualsTheFormulaInDoublePrecision) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-3, 3);
  for (const CloudKind kind : kKinds) {
    CloudSettings settings = small(kind, 33);
    settings.octaves = 5;
    const shared::CloudShape shape = cloud_params(settings).shape;
    for (int i = 0; i < 2000; ++i) {
      const glm::vec3 p(glm::dvec3(coordinate(random), coordinate(random), coordinate(random)));
      EXPECT_NEAR(double{shared::cloud_depth(shape, p)}, reference::cloud_depth(shape, glm::dvec3(p)),
                  reference::cloud_depth_error(shape, glm::dvec3(p)));
    }
  }
}

TEST(GenerateCloud, NoiseHasItsLimitMeanAndZeros) {
  std::mt19937 random(6);
  std::uniform_real_distribution<float> coordinate(-100, 100);
  double sum = 0, squares = 0, largest = 0;
  constexpr int kCount = 40000;
  for (int i = 0; i < kCount; ++i) {
    const glm::vec3 p(coordinate(random), coordinate(random), coordinate(random));
    const auto value = double{shared::lattice_noise(p, 9)};
    sum += value;
    squares += value * value;
    largest = std::max(largest, std::abs(value));
    ASSERT_EQ(shared::lattice_noise(glm::round(p), 9), 0);
  }
  EXPECT_LE(largest, double{shared::kLatticeNoiseLimit});
  EXPECT_GT(largest, 0.7);
  EXPECT_NEAR(sum / kCount, 0, 5 * std::sqrt(squares) / kCount);  // five standard errors
}

TEST(GenerateCloud, IsCentredAtTheOrigin) {
  for (const CloudKind kind : {CloudKind::sphere, CloudKind::slab, CloudKind::torus})
    for (const std::uint32_t edge : {32u, 33u}) {
      const Grid grid = generate_cloud(small(kind, edge));
      const Box<double> bounds = active_bounds(grid);
      const glm::dvec3 low(grid.world_from_index * glm::dvec4(bounds.low, 1));
      const glm::dvec3 high(grid.world_from_index * glm::dvec4(bounds.high, 1));
      EXPECT_LT(glm::length(low + high), 1e-9) << "kind " << int(kind) << " edge " << edge;
      EXPECT_NEAR(high.x, 0.3 * edge * 0.25, 0.25);
    }
}

TEST(GenerateCloud, HasTheVolumeOfItsShape) {
  for (const CloudKind kind : {CloudKind::sphere, CloudKind::slab, CloudKind::torus}) {
    CloudSettings settings = small(kind, 64);
    settings.edge_width = 0;
    const double r = settings.radius, pi = std::numbers::pi;
    const double volume = kind == CloudKind::sphere ? 4.0 / 3 * pi * r * r * r
                          : kind == CloudKind::slab ? 2 * r * 2 * r * r / 2
                                                    : 2 * pi * pi * 0.75 * r * r * r / 16;
    const double surface = kind == CloudKind::sphere ? 4 * pi * r * r
                           : kind == CloudKind::slab ? 2 * (4 * r * r + 2 * r * r)
                                                     : 4 * pi * pi * 0.75 * r * r / 4;
    // A voxel is whole or absent: half a diagonal of one on either side of the surface.
    const double v = settings.voxel_size;
    EXPECT_NEAR(sum_of(generate_cloud(settings)) * v * v * v, volume, surface * v * std::sqrt(3) / 2);
  }
}

TEST(GenerateCloud, DisplacesTheSphereOutwards) {
  CloudSettings settings = small(CloudKind::pyroclastic, 48);
  const Grid cloud = generate_cloud(settings);
  settings.amplitude = 0;
  const Grid bare = generate_cloud(settings);
  settings.kind = CloudKind::sphere;
  const Grid sphere = generate_cloud(settings);
  EXPECT_EQ(bare.values, sphere.values);
  EXPECT_GT(count_active(cloud), count_active(sphere) * 11 / 10);
  for (std::size_t i = 0; i < sphere.bricks.size(); ++i) {
    const auto brick = find_brick(cloud, sphere.bricks[i].origin);
    ASSERT_TRUE(brick);
    for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel)
      EXPECT_GE(value_of(cloud, *brick, voxel), value_of(sphere, i, voxel));
  }
}

TEST(GenerateCloud, SoftAndBinaryEdgesHaveTheSameSurface) {
  CloudSettings settings = small(CloudKind::pyroclastic, 40);
  const Grid soft = generate_cloud(settings);
  settings.edge_width = 0;
  const Grid binary = generate_cloud(settings);
  ASSERT_EQ(soft.bricks.size(), binary.bricks.size());
  for (std::size_t i = 0; i < soft.bricks.size(); ++i)
    EXPECT_EQ(soft.bricks[i].active, binary.bricks[i].active);
  EXPECT_EQ(sum_of(binary), static_cast<double>(count_active(binary)));
  EXPECT_LT(sum_of(soft), sum_of(binary));
}

TEST(GenerateCloud, FollowsItsSeedAndNotTheNumberOfThreads) {
  CloudSettings settings = small(CloudKind::pyroclastic, 40);
  set_thread_count(1);
  const Grid one = generate_cloud(settings);
  set_thread_count(3);
  const Grid three = generate_cloud(settings);
  set_thread_count(0);
  EXPECT_EQ(one.values, three.values);
  settings.seed = 4;
  EXPECT_NE(generate_cloud(settings).values, one.values);
}

// A cloud of the default settings is whole, whatever its seed.
TEST(GenerateCloud, FitsIntoItsCube) {
  for (std::uint32_t seed = 0; seed < (kSanitized ? 2 : 8); ++seed) {
    CloudSettings settings;
    settings.edge = 64;
    settings.voxel_size = 0.1;
    settings.seed = seed;
    const Box<double> bounds = active_bounds(generate_cloud(settings));
    EXPECT_GT(std::min({bounds.low.x, bounds.low.y, bounds.low.z}), 0) << seed;
    EXPECT_LT(std::max({bounds.high.x, bounds.high.y, bounds.high.z}), 63) << seed;
  }
}

}  // namespace
}  // namespace brume::grids
