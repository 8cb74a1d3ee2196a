// The balls that stand for what glows.
#include "grids/glow.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>
#include <span>

namespace brume::grids {
namespace {

/// A grid of float32 from a function of voxels, in bricks that are not 0 throughout.
Grid grid_of(int edge, const std::function<float(glm::ivec3)>& value_at) {
  Grid grid;
  grid.type = ValueType::float32;
  for_each_in(Box<int>{glm::ivec3(0), glm::ivec3(edge / 8)}, [&](glm::ivec3 brick) {
    std::array<float, kBrickVoxels> values{};
    Brick stored;
    stored.origin = 8 * brick;
    bool any = false;
    for (std::size_t i = 0; i < kBrickVoxels; ++i) {
      const glm::ivec3 local(i & 7, i >> 3 & 7, i >> 6);
      values[i] = value_at(8 * brick + local);
      if (values[i] == 0) continue;
      any = true;
      stored.active[i / 64] |= std::uint64_t{1} << (i % 64);
    }
    if (!any) return;
    grid.bricks.push_back(stored);
    const auto bytes = std::as_bytes(std::span(values));
    grid.values.insert(grid.values.end(), bytes.begin(), bytes.end());
  });
  return grid;
}

BrickVolume bricks_of(const Grid& grid) {
  return std::move(make_brick_volume(grid)).value_or_throw();
}

/// 1 in a ball.
std::function<float(glm::ivec3)> ball(glm::dvec3 middle, double radius, float value = 1) {
  return [=](glm::ivec3 at) { return glm::distance(glm::dvec3(at) + 0.5, middle) < radius ? value : 0.0f; };
}

TEST(Glow, OfABallIsThatBall) {
  const glm::dvec3 middle(17.3, 14.6, 16.1);
  const BrickVolume heat = bricks_of(grid_of(32, ball(middle, 6)));
  const BrickVolume density = bricks_of(grid_of(32, [](glm::ivec3) { return 0.5f; }));
  const std::vector<GlowBall> balls = find_glow(heat, density);
  ASSERT_EQ(balls.size(), 1u) << "smaller than two bricks";
  const double voxels = 4.0 / 3 * 3.14159265 * 6 * 6 * 6;
  EXPECT_NEAR(balls[0].fourth, voxels, 0.03 * voxels);
  EXPECT_LT(glm::distance(balls[0].middle, middle), 0.1);
  EXPECT_NEAR(balls[0].radius, 6, 0.1);
  EXPECT_NEAR(balls[0].value, 1, 1e-6);
  EXPECT_NEAR(balls[0].density * double{density.unit}, 0.5, 1e-3);
}

TEST(Glow, OfTwoBallsIsNotBetweenThem) {
  const auto one = ball({12, 12, 12}, 6), other = ball({100, 20, 12}, 6, 0.5f);
  const BrickVolume heat =
      bricks_of(grid_of(112, [&](glm::ivec3 at) { return std::max(one(at), other(at)); }));
  double near_one = 0, near_other = 0, sum = 0;
  for (const GlowBall& found : find_glow(heat, heat)) {
    sum += found.fourth;
    if (glm::distance(found.middle, glm::dvec3(12, 12, 12)) < 5) near_one += found.fourth;
    if (glm::distance(found.middle, glm::dvec3(100, 20, 12)) < 5) near_other += found.fourth;
  }
  EXPECT_NEAR(near_one + near_other, sum, 1e-9 * sum);
  EXPECT_NEAR(near_other / near_one, 1.0 / 16, 0.002) << "the fourth power";
}

// Nothing is lost where parts are divided, uniform bricks and other units included.
TEST(Glow, SumsUpToAllVoxels) {
  std::mt19937 random(3);
  std::uniform_real_distribution<float> unit(0, 3e5f);
  const Grid noise = grid_of(64, [&](glm::ivec3 at) { return at.x < 32 ? 1e5f : unit(random); });
  const BrickVolume heat = bricks_of(noise);
  const std::vector<GlowBall> balls = find_glow(heat, heat);
  EXPECT_EQ(balls.size(), kMostGlowBalls);
  double found = 0, expected = 0;
  for (const GlowBall& one : balls) found += one.fourth;
  const auto* values = reinterpret_cast<const float*>(noise.values.data());
  for (std::size_t i = 0; i < noise.values.size() / sizeof(float); ++i)
    expected += std::pow(double{values[i]} / double{heat.unit}, 4);
  EXPECT_NEAR(found, expected, 4 * expected / 2048) << "rounded to halves";
}

TEST(Glow, NothingGlowsInAColdGrid) {
  const BrickVolume cold = bricks_of(grid_of(8, [](glm::ivec3) { return 0.0f; }));
  EXPECT_TRUE(find_glow(cold, cold).empty());
}

// Against paths from random points of the ball in random directions.
TEST(Glow, EscapesFromABallAsRandomPathsDo) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> unit(0, 1);
  const auto direction = [&] {
    return glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
  };
  for (const double x : {0.01, 0.049, 0.051, 0.5, 2.0, 8.0}) {
    constexpr int kPaths = 200000;
    double sum = 0, squares = 0;
    for (int i = 0; i < kPaths; ++i) {
      const glm::dvec3 from = std::cbrt(unit(random)) * direction(), to = direction();
      const double along = glm::dot(from, to);
      const double path = -along + std::sqrt(along * along + 1 - glm::dot(from, from));
      const double passed = std::exp(-x * path);
      sum += passed;
      squares += passed * passed;
    }
    const double mean = sum / kPaths, deviation = std::sqrt((squares / kPaths - mean * mean) / kPaths);
    EXPECT_NEAR(escape_from_ball(x), mean, 5 * deviation + 2e-5) << x;
  }
}

}  // namespace
}  // namespace brume::grids
