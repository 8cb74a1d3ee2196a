#include "scenario/wall_smoke.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "core/box.hpp"
#include "grids/check.hpp"
#include "voxel/voxelize.hpp"

namespace brume::scenario {
namespace {

void add_wall(std::vector<voxel::Triangle>& triangles, const glm::vec3& low, const glm::vec3& high) {
  const auto corner = [&](int i) {
    return glm::mix(low, high, glm::bvec3((i & 1) != 0, (i & 2) != 0, (i & 4) != 0));
  };
  constexpr int kSides[6][4] = {{0, 2, 6, 4}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                {2, 3, 7, 6}, {0, 1, 3, 2}, {4, 5, 7, 6}};
  for (const auto& side : kSides) {
    triangles.push_back({corner(side[0]), corner(side[1]), corner(side[2])});
    triangles.push_back({corner(side[0]), corner(side[2]), corner(side[3])});
  }
}

constexpr float kVoxel = 0.25f;

/// A closed room whose walls, 0.1 m and 0.6 m thick, lie anywhere among voxels, full of smoke in one half: a
/// thin wall divides it.
struct SmokyRoom {
  static std::vector<voxel::Triangle> walls() {
    std::vector<voxel::Triangle> triangles;
    add_wall(triangles, {-3.1f, -0.1f, -2.1f}, {3.1f, 0, 2.1f});     // floor
    add_wall(triangles, {-3.1f, 2.63f, -2.1f}, {3.1f, 3.2f, 2.1f});  // ceiling
    add_wall(triangles, {-3.11f, 0, -2.1f}, {-3.01f, 2.63f, 2.1f});  // left
    add_wall(triangles, {2.93f, 0, -2.1f}, {3.5f, 2.63f, 2.1f});     // right
    add_wall(triangles, {-3.1f, 0, -2.17f}, {3.1f, 2.63f, -1.83f});  // back
    add_wall(triangles, {-3.1f, 0, 1.9f}, {3.1f, 2.63f, 2.0f});      // front
    add_wall(triangles, {0.31f, 0, -1.83f}, {0.36f, 2.63f, 1.9f});   // across
    return triangles;
  }
  SmokyRoom() {
    sim::ThrowSmoke smoke;
    smoke.from = smoke.at = sim::position_from_metres({-1.5, 1, 0});
    smoke.smoke.voxels = 4000;
    smoke.smoke.hold_ticks = 10000;
    world.append(smoke).value_or_throw();
    world.advance_to(600);
    field.update(world);
  }
  /// Whether a point is between the surfaces.
  static bool inside(const glm::vec3& world) {
    return Box<float>{{-3.01f, 0, -1.83f}, {0.31f, 2.63f, 1.9f}}.contains(world);
  }
  grids::Grid exported() const { return smoke_grid_up_to_walls(field, {}); }
  std::vector<voxel::Triangle> triangles = walls();
  voxel::BitGrid level = voxel::voxelize(triangles, {{32, 20, 24}, kVoxel, {-4, -0.9f, -3}}).value_or_throw();
  voxel::SurfacePlanes planes = voxel::SurfacePlanes::build(triangles, level);
  sim::World world{level};
  smoke::Field field{level, planes};
};

float density_at(const grids::Grid& grid, glm::ivec3 voxel) {
  const auto brick = grids::find_brick(grid, voxel & ~7);
  if (!brick) return 0;
  const glm::uvec3 local(voxel & 7);
  float value = 0;
  std::memcpy(&value, grid.values_of(*brick).data() + (local.x + 8 * (local.y + 8 * local.z)) * sizeof(float),
              sizeof(float));
  return value;
}

/// As other programs sample it, by linear interpolation.
double sampled(const grids::Grid& grid, const glm::vec3& p_voxel) {
  const glm::ivec3 cell(glm::floor(p_voxel - 0.5f));
  const glm::vec3 f = p_voxel - 0.5f - glm::vec3(cell);
  double sum = 0;
  for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(2)}, [&](glm::ivec3 corner) {
    const glm::vec3 near = glm::mix(1.0f - f, f, glm::vec3(corner));
    sum += double{near.x * near.y * near.z * density_at(grid, cell + corner)};
  });
  return sum;
}

/// Depths along an axis through all of the level; of what is exported also the part from wall to wall.
struct Depths {
  double drawn = 0, exported = 0, between_walls = 0, interpolated = 0;
};
Depths depths_along(const SmokyRoom& room, const grids::Grid& grid, const grids::Grid& plain, int axis,
                    glm::vec3 p_voxel) {
  constexpr int kSteps = 64;  // a voxel
  Depths depths;
  for (int i = 0; i < room.level.size()[axis] * kSteps; ++i) {
    p_voxel[axis] = (static_cast<float>(i) + 0.5f) / kSteps;
    const double exported = sampled(grid, p_voxel);
    depths.exported += exported / kSteps;
    depths.interpolated += sampled(plain, p_voxel) / kSteps;
    // Rays see no smoke within solids, where drawn densities go on.
    if (!SmokyRoom::inside(room.level.layout().origin_world + kVoxel * p_voxel)) continue;
    depths.drawn += double{smoke::sample_density(room.field.volume(), p_voxel)} / kSteps;
    depths.between_walls += exported / kSteps;
  }
  return depths;
}

TEST(WallSmoke, DepthsAreThoseOfTheDrawnSmoke) {
  const SmokyRoom room;
  const grids::Grid grid = room.exported(), plain = smoke_grid(room.world.state(), {});
  grids::check_grid(grid).value_or_throw();
  const auto voxel_of = [&](const glm::vec3& world) {
    return (world - room.level.layout().origin_world) / kVoxel;
  };
  // From wall to wall, a voxel and more from the other walls, at any place among the voxels.
  for (const int axis : {0, 1, 2}) {
    Depths mean;
    for (int i = 0; i < 40; ++i) {
      const float u = static_cast<float>(i) / 40, v = glm::fract(static_cast<float>(i) * 0.618034f);
      const glm::vec3 at = glm::mix(glm::vec3(-2.4f, 0.5f, -1.3f), glm::vec3(-0.3f, 2.1f, 1.3f),
                                    glm::vec3(u, axis == 0 ? u : v, v));
      const Depths depths = depths_along(room, grid, plain, axis, voxel_of(at));
      EXPECT_GT(depths.drawn, 9) << axis << " " << i;
      EXPECT_NEAR(depths.exported, depths.drawn, 0.02 * depths.drawn) << axis << " " << i;
      mean.drawn += depths.drawn;
      // Up to an eighth of a voxel beyond each surface.
      EXPECT_NEAR(depths.between_walls, depths.exported, 0.3) << axis << " " << i;
      mean.exported += depths.exported;
      mean.between_walls += depths.between_walls;
      mean.interpolated += depths.interpolated;
    }
    std::printf("axis %d: exported %.4f, from wall to wall %.4f, before %.4f of the drawn depth\n", axis,
                mean.exported / mean.drawn, mean.between_walls / mean.drawn, mean.interpolated / mean.drawn);
    EXPECT_LT(mean.interpolated, 0.99 * mean.drawn) << "smoke ends before walls";
  }
}

TEST(WallSmoke, NoVoxelWithoutSmokeGetsAny) {
  const SmokyRoom room;
  const grids::Grid grid = room.exported(), plain = smoke_grid(room.world.state(), {});
  ASSERT_EQ(grid.bricks.size(), plain.bricks.size());
  int beside_walls = 0, inside = 0;
  for_each_in(Box<int>{glm::ivec3(0), room.level.size()}, [&](glm::ivec3 voxel) {
    const float value = density_at(grid, voxel), before = density_at(plain, voxel);
    EXPECT_EQ(value > 0, before > 0);
    EXPECT_GE(value, 0);
    bool touches_wall = false;
    for_each_in(Box<int>{voxel - 2, voxel + 3},
                [&](glm::ivec3 other) { touches_wall = touches_wall || room.level.solid(other); });
    if (!touches_wall) {
      EXPECT_EQ(value, before);
    }
    inside += !touches_wall && value > 0;
    beside_walls += value > 1.2f * before;
  });
  for (std::size_t i = 0; i < grid.bricks.size(); ++i)
    EXPECT_EQ(grid.bricks[i].active, plain.bricks[i].active);
  EXPECT_GT(inside, 100);
  EXPECT_GT(beside_walls, 100);
  // Behind the wall across, from half a voxel on.
  const glm::vec3 behind =
      (glm::vec3(0.36f + 1.5f * kVoxel, 1, 0) - room.level.layout().origin_world) / kVoxel;
  EXPECT_EQ(sampled(grid, behind), 0);
}

}  // namespace
}  // namespace brume::scenario
