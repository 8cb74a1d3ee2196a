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

/// Sum, middle and radius of all balls together.
GlowBall together(const std::vector<GlowBall>& balls) {
  GlowBall all;
  double squares = 0;
  for (const GlowBall& ball : balls) {
    all.power += ball.power;
    all.middle += ball.power * ball.middle;
    all.density += ball.power * ball.density;
    all.value += ball.power * ball.value;
  }
  all.middle /= all.power;
  all.density /= all.power;
  all.value /= all.power;
  for (const GlowBall& ball : balls) {
    const glm::dvec3 off = ball.middle - all.middle;
    squares += ball.power * (0.6 * ball.radius * ball.radius + glm::dot(off, off));
  }
  all.radius = std::sqrt(squares / all.power / 0.6);
  return all;
}

TEST(Glow, OfABallIsThatBall) {
  for (const double radius : {4.0, 6.0, 12.0}) {
    const glm::dvec3 middle(17.3, 14.6, 16.1);
    const BrickVolume heat = bricks_of(grid_of(32, ball(middle, radius)));
    const BrickVolume density = bricks_of(grid_of(32, [](glm::ivec3) { return 0.5f; }));
    const std::vector<GlowBall> balls = find_glow(heat, density);
    if (radius < 4.4) {
      EXPECT_EQ(balls.size(), 1u) << "of a few voxels";
    }
    const GlowBall all = together(balls);
    const double voxels = 4.0 / 3 * 3.14159265 * radius * radius * radius;
    EXPECT_NEAR(all.power, voxels, 0.05 * voxels) << radius;
    EXPECT_LT(glm::distance(all.middle, middle), 0.1) << radius;
    // The voxels of a ball have its volume but for 5 %, hence its radius but for a third of that.
    EXPECT_NEAR(all.radius, radius, 0.05 / 3 * radius) << radius;
    EXPECT_NEAR(all.value, 1, 1e-6);
    EXPECT_NEAR(all.density * double{density.unit}, 0.5, 1e-3);
  }
}

TEST(Glow, OfTwoBallsIsNotBetweenThem) {
  const auto one = ball({12, 12, 12}, 6), other = ball({100, 20, 12}, 6, 0.5f);
  const BrickVolume heat =
      bricks_of(grid_of(112, [&](glm::ivec3 at) { return std::max(one(at), other(at)); }));
  double near_one = 0, near_other = 0, sum = 0;
  for (const GlowBall& found : find_glow(heat, heat)) {
    sum += found.power;
    if (glm::distance(found.middle, glm::dvec3(12, 12, 12)) < 5) near_one += found.power;
    if (glm::distance(found.middle, glm::dvec3(100, 20, 12)) < 5) near_other += found.power;
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
  for (const GlowBall& one : balls) found += one.power;
  const auto* values = reinterpret_cast<const float*>(noise.values.data());
  for (std::size_t i = 0; i < noise.values.size() / sizeof(float); ++i)
    expected += std::pow(double{values[i]} / double{heat.unit}, 4);
  EXPECT_NEAR(found, expected, 4 * expected / 2048) << "rounded to halves";
}

// Half the resolution keeps the power.
TEST(Glow, SumsUpToTheSameAtLowerResolutions) {
  std::mt19937 random(4);
  std::uniform_real_distribution<float> unit(0, 1);
  const Grid noise = grid_of(32, [&](glm::ivec3) { return unit(random); });
  const auto sum_of = [](const BrickVolume& heat) {
    double sum = 0;
    for (const GlowBall& ball : find_glow(heat, heat)) sum += ball.power;
    return sum * std::exp2(3 * heat.level);
  };
  const BrickVolume fine = bricks_of(noise);
  const double expected = sum_of(fine);
  BrickVolumeOptions half;
  half.max_bricks = 40;
  half.glows = true;
  const BrickVolume halved = std::move(make_brick_volume(noise, half)).value_or_throw();
  EXPECT_GT(halved.level, 0);
  EXPECT_NEAR(sum_of(halved), expected, 8 * expected / 2048) << "rounded to halves";
  const BrickVolume preview = make_preview(fine, 40, true);
  EXPECT_GT(preview.level, 0);
  EXPECT_NEAR(sum_of(preview), expected, 8 * expected / 2048);
}

TEST(Glow, NothingGlowsInAColdGrid) {
  const BrickVolume cold = bricks_of(grid_of(8, [](glm::ivec3) { return 0.0f; }));
  EXPECT_TRUE(find_glow(cold, cold).empty());
}

// A ball that grows beside one that shrinks while both move: at no point around them does the light change by
// more from step to step than that of the voxels themselves, and 2 %.
TEST(Glow, DoesNotFlicker) {
  constexpr int kSteps = 60;
  const std::array<glm::dvec3, 4> seen{glm::dvec3(32, -10, 32), {70, 30, 30}, {20, 80, 40}, {-15, 32, 10}};
  std::array<double, 4> before{}, exact_before{};
  for (int step = 0; step <= kSteps; ++step) {
    const double at = static_cast<double>(step) / kSteps;
    const glm::dvec3 a(16 + 30 * at, 20, 30), b(44, 44 - 20 * at, 20 + 20 * at);
    const Grid grid = grid_of(64, [&](glm::ivec3 v) {
      const glm::dvec3 p = glm::dvec3(v) + 0.5;
      const double one = glm::max(1.0 - glm::distance(p, a) / (8 + 6 * at), 0.0);
      const double other = glm::max(1.0 - glm::distance(p, b) / (15 - 6 * at), 0.0);
      return static_cast<float>(std::max(one, other));
    });
    const BrickVolume heat = bricks_of(grid);
    const std::vector<GlowBall> balls = find_glow(heat, heat);
    for (std::size_t i = 0; i < seen.size(); ++i) {
      double light = 0, exact = 0;
      for (const GlowBall& ball : balls) {
        const glm::dvec3 off = seen[i] - ball.middle;
        light += ball.power / std::max(glm::dot(off, off), ball.radius * ball.radius);
      }
      const auto* values = reinterpret_cast<const float*>(grid.values.data());
      for (std::size_t brick = 0; brick < grid.bricks.size(); ++brick)
        for (std::size_t v = 0; v < kBrickVoxels; ++v) {
          const glm::dvec3 local(v & 7, v >> 3 & 7, v >> 6);
          const glm::dvec3 off = seen[i] - glm::dvec3(grid.bricks[brick].origin) - local - 0.5;
          exact += std::pow(double{values[brick * kBrickVoxels + v]}, 4) / glm::dot(off, off);
        }
      if (step > 0) {
        EXPECT_LT(std::abs(light / before[i] - 1), std::abs(exact / exact_before[i] - 1) + 0.02)
            << step << " " << i;
      }
      // A point in the place of a ball of deviation s at a distance d is off by 3 s^2 / d^2: s is at most 8,
      // d at least 25.
      EXPECT_NEAR(light, exact, 0.31 * exact) << step << " " << i;
      before[i] = light;
      exact_before[i] = exact;
    }
  }
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

// Along each axis of a block the length of its edge, of the fourth power and of the density; whatever unit
// halves are stored in.
TEST(GlowColumns, OfABlockAreItsEdges) {
  constexpr double kVoxel = 0.25;
  const glm::ivec3 size(16, 24, 8);
  const auto block = [&](float value) {
    Grid grid = grid_of(24, [&](glm::ivec3 at) { return glm::all(glm::lessThan(at, size)) ? value : 0.0f; });
    grid.world_from_index = glm::dmat4(glm::dmat3(kVoxel));
    return bricks_of(grid);
  };
  for (const float value : {0.5f, 3072.0f}) {
    const std::vector<GlowColumn> columns = glow_columns(block(value), block(2));
    std::vector<double> expected;  // columns across x, y and z
    for (const auto& [axis, count] : {std::pair(0, 3), {1, 2}, {2, 6}})
      expected.insert(expected.end(), static_cast<std::size_t>(count), kVoxel * size[axis]);
    ASSERT_EQ(columns.size(), expected.size());
    for (std::size_t i = 0; i < columns.size(); ++i) {
      EXPECT_DOUBLE_EQ(columns[i].power, expected[i] * std::pow(double{value}, 4)) << i;
      EXPECT_DOUBLE_EQ(columns[i].density, 2 * expected[i]) << i;
    }
  }
  // The density counts where it glows: half of the voxels of a brick.
  const BrickVolume half = bricks_of(grid_of(8, [](glm::ivec3 at) { return at.x < 4 ? 1.0f : 0.0f; }));
  const BrickVolume whole = bricks_of(grid_of(8, [](glm::ivec3) { return 1.0f; }));
  for (const GlowColumn& column : glow_columns(half, whole)) {
    EXPECT_DOUBLE_EQ(column.power, 4);
    EXPECT_DOUBLE_EQ(column.density, 4);
  }
  EXPECT_TRUE(glow_columns(bricks_of(grid_of(8, [](glm::ivec3) { return 0.0f; })), whole).empty());
}

}  // namespace
}  // namespace brume::grids
