// Tanks as volume grids: where they are, what they hold, how they are reduced.
#include "grids/files/tank_grids.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "grids/files/grid_files.hpp"
#include "grids/metadata.hpp"
#include "spheres/color.hpp"
#include "spheres/file.hpp"
#include "spheres/paint.hpp"
#include "tests/log_lines.hpp"

namespace brume::grids {
namespace {

using spheres::Color;
using spheres::Tank;

Tank small_tank() {
  Tank tank;
  tank.size = {21, 10, 13};
  tank.voxel = 0.25f;
  tank.spheres = {{{5, 5, 5}, 4}, {{14, 5, 6}, 3.5f}, {{18, 2, 11}, 1.5f}};
  tank.colors = {0xff8040c0u, 0x80ffffffu, 0x00ffffffu};  // opaque, a medium, nothing
  return tank;
}

template <typename Value>
Value value_at(const Grid& grid, const glm::ivec3& index) {
  Value value{};
  const auto brick = find_brick(grid, index / 8 * 8);
  if (!brick) return value;
  const glm::ivec3 in = index % 8;
  const auto voxel = static_cast<std::size_t>(in.x + 8 * (in.y + 8 * in.z));
  std::memcpy(&value, grid.values_of(*brick).data() + voxel * sizeof value, sizeof value);
  return value;
}

template <typename Visit>
void for_each_index(const glm::ivec3& size, const Visit& visit) {
  for (int z = 0; z < size.z; ++z)
    for (int y = 0; y < size.y; ++y)
      for (int x = 0; x < size.x; ++x) visit(glm::ivec3(x, y, z));
}

TEST(TankGrids, HoldTheExtinctionAndColoursOfPaintedVoxels) {
  const Tank tank = small_tank();
  const auto file = tank_grids(tank, "tank").value_or_throw();
  ASSERT_EQ(file.grids.size(), 2u);
  const Grid &density = file.grids[0], &colors = file.grids[1];
  EXPECT_EQ(density.name, "density");
  EXPECT_EQ(colors.name, "Cd");
  EXPECT_TRUE(is_extinction_per_metre(density));
  EXPECT_FALSE(is_extinction_per_metre(colors));
  const std::vector<Color> paint = spheres::paint(tank);
  std::uint64_t active = 0;
  for_each_index(glm::ivec3(tank.size), [&](const glm::ivec3& v) {
    const Color color = paint[static_cast<std::size_t>((v.z * 10 + v.y) * 21 + v.x)];
    const double a = (color >> 24) / 255.0;
    const double expected = -std::log(1 - std::min(a, kOpaqueVoxel)) / 0.25;
    ASSERT_FLOAT_EQ(value_at<float>(density, v), static_cast<float>(expected));
    if (color >> 24 == 0) return;
    ++active;
    ASSERT_EQ(value_at<glm::vec3>(colors, v), spheres::albedo_of(color));
  });
  EXPECT_GT(active, 300u);
  EXPECT_EQ(count_active(density), active);
  EXPECT_EQ(count_active(colors), active);
}

TEST(TankGrids, LieInTheWorldAsTanksDo) {
  const Tank tank = small_tank();
  const GridFile file = tank_grids(tank, "tank").value_or_throw();
  // The middle of voxel (0, 0, 0) is half a voxel from the low corner, which is half a tank from the origin.
  const glm::dvec4 first = file.grids[0].world_from_index * glm::dvec4(0, 0, 0, 1);
  EXPECT_EQ(glm::dvec3(first), 0.25 * (glm::dvec3(0.5) - glm::dvec3(21, 10, 13) / 2.0));
  const glm::dvec4 next = file.grids[1].world_from_index * glm::dvec4(1, 0, 0, 1);
  EXPECT_EQ(next.x - first.x, 0.25);
}

TEST(TankGrids, AreReducedToMeansThatFit) {
  const Tank tank = small_tank();
  const LogLines log;
  GridLimits limits;
  limits.tank_voxels = 6 * 3 * 4;  // a quarter along each axis, rounded up
  const GridFile coarse = tank_grids(tank, "tank.spheres", limits).value_or_throw();
  EXPECT_TRUE(log.has("tank.spheres: as a volume it is shown at 1/4 of its resolution, 6x3x4 voxels"));
  const GridFile fine = tank_grids(tank, "tank").value_or_throw();
  double sum = 0, expected = 0;
  glm::dvec3 color_sum(0), color_expected(0);
  for_each_index({6, 3, 4}, [&](const glm::ivec3& v) {
    const double density = value_at<float>(coarse.grids[0], v);
    sum += 64 * density;
    color_sum += 64 * density * glm::dvec3(value_at<glm::vec3>(coarse.grids[1], v));
  });
  for_each_index(glm::ivec3(tank.size), [&](const glm::ivec3& v) {
    const double density = value_at<float>(fine.grids[0], v);
    expected += density;
    color_expected += density * glm::dvec3(value_at<glm::vec3>(fine.grids[1], v));
  });
  // Densities are rounded to 2^-24 of them; colours are float sums of up to 64 terms, 64 * 2^-24.
  EXPECT_NEAR(sum, expected, expected * 0x1p-23);
  EXPECT_LT(glm::length(color_sum - color_expected), expected * 0x1p-18);
  // The low corner stays where it is.
  EXPECT_EQ(coarse.grids[0].world_from_index[0][0], 1.0);
  EXPECT_EQ(coarse.grids[0].world_from_index[3].x, 0.25 * -10.5 + 0.5);
}

TEST(TankGrids, AreMadeAsChosenWithinLimits) {
  const Tank tank = small_tank();
  std::vector<std::string> names;
  const GridFile only_color = tank_grids(tank, "tank", {}, [&](std::span<const Grid* const> heads) {
                                for (const Grid* head : heads) names.push_back(head->name);
                                return Result<std::vector<std::size_t>>(std::vector<std::size_t>{1});
                              }).value_or_throw();
  EXPECT_EQ(names, (std::vector<std::string>{"density", "Cd"}));
  ASSERT_EQ(only_color.grids.size(), 1u);
  EXPECT_EQ(only_color.grids[0].name, "Cd");
  GridLimits limits;
  limits.bytes = 10000;
  const auto refused = tank_grids(tank, "tank", limits);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.failure().code, ErrorCode::resource_limit);
  Tank empty;
  empty.size = {9, 1, 1};
  EXPECT_TRUE(tank_grids(empty, "tank").value_or_throw().grids[0].bricks.empty());
}

TEST(TankGrids, AreLoadedFromFilesOfTanks) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "small.spheres";
  ASSERT_TRUE(spheres::save_tank(path, small_tank()));
  EXPECT_TRUE(is_grid_file(path));
  const auto file = load_grid_file(path).value_or_throw();
  const GridFile expected = tank_grids(small_tank(), "tank").value_or_throw();
  ASSERT_EQ(file.grids.size(), 2u);
  EXPECT_EQ(file.grids[0].values, expected.grids[0].values);
  EXPECT_EQ(file.grids[1].values, expected.grids[1].values);
  std::filesystem::remove(path);
  EXPECT_EQ(load_grid_file(path).failure().code, ErrorCode::bad_input);
}

}  // namespace
}  // namespace brume::grids
