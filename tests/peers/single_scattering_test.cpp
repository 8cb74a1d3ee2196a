// The reference of script/bench-peers against what a volume lit along the line of sight scatters, whatever
// its densities: with the optical depth x between eye and end, (1 - exp(-2 x)) / 2 if the sun is behind the
// eye, and x exp(-x) if the volume is between eye and sun.
#include "bench/peers/single_scattering.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <random>

namespace brume::peers {
namespace {

/// A brick of densities at an origin.
grids::Grid grid_of(const std::vector<float>& values, glm::ivec3 origin = glm::ivec3(0)) {
  grids::Grid grid;
  grid.name = "density";
  grid.bricks.push_back({origin, {}});
  grid.bricks[0].active.fill(~std::uint64_t{0});
  grid.values.resize(sizeof(float) * values.size());
  std::memcpy(grid.values.data(), values.data(), grid.values.size());
  return grid;
}

std::vector<float> random_values(unsigned seed) {
  std::mt19937 random(seed);
  std::vector<float> values(grids::kBrickVoxels);
  for (float& value : values) value = std::uniform_real_distribution<float>(0, 1)(random);
  return values;
}

/// A pixel that looks at the middle of a brick at index 0 of an identity transform.
SingleScattering pixel(double extinction) {
  SingleScattering scene;
  scene.eye = {30, 22, 41};
  scene.target = {3.2, 3.7, 3.4};
  scene.fov = 0.1;
  scene.extinction = extinction;
  return scene;
}

glm::dvec3 forward_of(const SingleScattering& scene) {
  return glm::normalize(scene.target - scene.eye);
}

float only_value(const Radiances& values) {
  EXPECT_EQ(values.size(), 1u);
  return values.at(0);
}

// What is stored as a float and ends at 1e-7 of the light.
constexpr double kRounding = 3e-7;

TEST(SingleScatteringTest, AlongTheLineOfSightItIsAFunctionOfTheOpticalDepth) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    const auto field = DenseField::from(grid_of(random_values(seed)));
    ASSERT_TRUE(field);
    SingleScattering scene = pixel(0.05 * (seed + 1));
    scene.to_sun = -forward_of(scene);
    const double front = double{only_value(integrate_cells(*field, scene, 4))};
    const double depth = -0.5 * std::log(1 - 2 * front);
    EXPECT_GT(depth, 0.05);
    scene.to_sun = forward_of(scene);
    // The depth's error grows by the slope of the logarithm.
    EXPECT_NEAR(double{only_value(integrate_cells(*field, scene, 4))}, depth * std::exp(-depth),
                kRounding * (1 + 1 / (1 - 2 * front)))
        << seed;
  }
}

TEST(SingleScatteringTest, AFullBrickHasTheDepthOfItsVoxels) {
  const auto field = DenseField::from(grid_of(std::vector<float>(grids::kBrickVoxels, 1), {16, -8, 0}));
  ASSERT_TRUE(field);
  SingleScattering scene;
  scene.eye = {19.5, -4.5, 100};
  scene.target = {19.5, -4.5, 0};
  scene.fov = 0.01;
  scene.extinction = 0.1;
  scene.to_sun = {0, 0, 1};
  // The ramps of the two ends are half a voxel each: eight voxels in all.
  EXPECT_NEAR(only_value(integrate_cells(*field, scene, 3)), 0.5 * (1 - std::exp(-1.6)), kRounding);
}

TEST(SingleScatteringTest, SamplesLieAtIntegers) {
  std::vector<float> values(grids::kBrickVoxels, 0);
  values[3 + 8 * (4 + 8 * 5)] = 1;
  const auto field = DenseField::from(grid_of(values));
  ASSERT_TRUE(field);
  SingleScattering scene;
  scene.eye = {3, 4, 25};
  scene.target = {3, 4, 5};
  scene.fov = 2 * std::atan(1.5 / 20);  // half a voxel to a pixel's side, at its distance
  scene.width = scene.height = 3;
  scene.to_sun = {0, 0, 1};
  scene.extinction = 1e-3;
  const Radiances image = integrate_cells(*field, scene, 3);
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(image[i], image[8 - i], 1e-9) << "symmetric about " << i;
  // A tent of height 1 over two voxels.
  EXPECT_NEAR(image[4], 1e-3, 1e-6);
  EXPECT_LT(image[0], image[1]);
  EXPECT_LT(image[1], image[4]);
}

TEST(SingleScatteringTest, TransformsMoveTheField) {
  grids::Grid grid = grid_of(random_values(7));
  SingleScattering scene = pixel(0.3);
  scene.width = 5, scene.height = 3, scene.fov = 0.4;
  scene.to_sun = glm::normalize(glm::dvec3(2, 5, -1));
  const auto before = DenseField::from(grid);
  ASSERT_TRUE(before);
  const Radiances expected = integrate_cells(*before, scene, 2);
  // Half the size, elsewhere, and as much extinction more.
  const glm::dvec3 moved(10, -20, 5);
  grid.world_from_index = glm::scale(glm::translate(glm::dmat4(1), moved), glm::dvec3(0.5));
  const auto after = DenseField::from(grid);
  ASSERT_TRUE(after);
  scene.eye = moved + 0.5 * scene.eye;
  scene.target = moved + 0.5 * scene.target;
  scene.extinction *= 2;
  const Radiances found = integrate_cells(*after, scene, 2);
  for (std::size_t i = 0; i < expected.size(); ++i) EXPECT_NEAR(found[i], expected[i], kRounding) << i;
}

TEST(SingleScatteringTest, EqualStepsConvergeToIt) {
  const auto field = DenseField::from(grid_of(random_values(3)));
  ASSERT_TRUE(field);
  SingleScattering scene = pixel(0.2);
  scene.to_sun = glm::normalize(glm::dvec3(1, 2, 0.5));
  const double exact = double{only_value(integrate_cells(*field, scene, 4))};
  const double coarse = std::abs(double{only_value(integrate_steps(*field, scene, 0.25))} - exact);
  const double fine = std::abs(double{only_value(integrate_steps(*field, scene, 0.01))} - exact);
  EXPECT_LT(coarse, 1e-2 * exact);
  EXPECT_LT(fine, 1e-4 * exact);
}

TEST(SingleScatteringTest, RefusesWhatItWouldGetWrong) {
  grids::Grid grid = grid_of(random_values(1));
  grid.background[3] = std::byte{1};
  EXPECT_FALSE(DenseField::from(grid));
  grid = grid_of(random_values(1));
  grid.tiles.push_back({{64, 0, 0}, 8, true, {}});
  EXPECT_FALSE(DenseField::from(grid));
  grid = grid_of(random_values(1));
  grid.world_from_index = glm::scale(glm::dmat4(1), glm::dvec3(1, 0, 1));
  EXPECT_FALSE(DenseField::from(grid));
  EXPECT_FALSE(DenseField::from(grids::Grid{}));
}

}  // namespace
}  // namespace brume::peers
