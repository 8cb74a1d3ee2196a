#include "spheres/pack.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <vector>

#include "core/progress.hpp"
#include "core/tasks.hpp"
#include "tests/sanitized.hpp"
#include "tests/spheres/tank_checks.hpp"

namespace brume::spheres {
namespace {

constexpr Arrangement kArrangements[] = {Arrangement::random, Arrangement::largest_first, Arrangement::noise,
                                         Arrangement::coral};

PackOptions small_options(Arrangement arrangement) {
  PackOptions options;
  options.size = {150, 100, 50};
  options.count = kSanitized ? 1500 : 6000;
  options.radius = {0.7f, 7};
  options.arrangement = arrangement;
  options.noise_size = 40;
  options.seed = 3;
  options.palette = {0x0000ff, 0x00ff00, 0xff0000};
  return options;
}

Tank packed(const PackOptions& options) {
  return pack(options).value_or_throw();
}

class Packing : public testing::TestWithParam<Arrangement> {
 protected:
  ~Packing() override { set_thread_count(0); }
};
INSTANTIATE_TEST_SUITE_P(Arrangements, Packing, testing::ValuesIn(kArrangements));

TEST_P(Packing, HasNoOverlapsAndIsInside) {
  const PackOptions options = small_options(GetParam());
  const Tank tank = packed(options);
  EXPECT_EQ(tank.spheres.size(), options.count) << "a quarter of the tank";
  EXPECT_EQ(tank.size, options.size);
  EXPECT_EQ(tank.voxel, options.voxel);
  expect_packed(tank);
  for (const Sphere& sphere : tank.spheres) {
    EXPECT_GE(sphere.radius, options.radius.x);
    EXPECT_LE(sphere.radius, options.radius.y);
  }
}

TEST_P(Packing, IsTheSameForAnyNumberOfThreads) {
  const PackOptions options = small_options(GetParam());
  set_thread_count(1);
  const Tank one = packed(options);
  for (const unsigned threads : {2u, 8u}) {
    set_thread_count(threads);
    const Tank tank = packed(options);
    EXPECT_EQ(tank.spheres, one.spheres) << threads;
    EXPECT_EQ(tank.colors, one.colors) << threads;
  }
  PackOptions other = options;
  other.seed = 4;
  EXPECT_NE(packed(other).spheres, one.spheres);
}

TEST_P(Packing, OfOddSizes) {
  for (const glm::uvec3 size :
       {glm::uvec3(1), glm::uvec3(7), glm::uvec3(33, 17, 5), glm::uvec3(2048, 1, 2)}) {
    PackOptions options = small_options(GetParam());
    options.size = size;
    options.count = 200;
    // The largest has one place along the shortest side.
    const float most = static_cast<float>(std::min({size.x, size.y, size.z})) / 2;
    for (const glm::vec2 radius : {glm::vec2(most, most), glm::vec2(most / 16, most)}) {
      options.radius = radius;
      const Tank tank = packed(options);
      EXPECT_GE(tank.spheres.size(), 1u);
      expect_packed(tank);
    }
  }
}

TEST_P(Packing, OfWhatCannotFitEndsWithFewer) {
  PackOptions options = small_options(GetParam());
  options.size = glm::uvec3(20);
  options.count = kMostSpheres;
  options.radius = {1, 3};
  const Tank tank = packed(options);
  // No packing of equal balls fills more than pi / sqrt(18); of these sizes, small ones between large, all of
  // the volume bounds their number.
  EXPECT_LT(tank.spheres.size(), 8000 / 4.18);
  EXPECT_GT(tank.spheres.size(), 20u);
  expect_packed(tank);
}

TEST_P(Packing, StopsEarlyWithWhatIsPacked) {
  PackOptions options = small_options(GetParam());
  options.count = kMostSpheres;
  options.radius = {0.1f, 1};
  std::atomic<int> calls{0};
  const Tank tank = pack(options, [&] { return ++calls > 40; }).value_or_throw();
  EXPECT_GT(tank.spheres.size(), 0u);
  EXPECT_LT(tank.spheres.size(), options.count);
  EXPECT_LT(calls, 60) << "no more work after it";
  expect_packed(tank);
  EXPECT_EQ(pack(options, [] { return true; }).value_or_throw().spheres.size(), 0u);
}

TEST_P(Packing, OfNoSpheres) {
  PackOptions options = small_options(GetParam());
  options.count = 0;
  EXPECT_EQ(packed(options).spheres.size(), 0u);
}

TEST_P(Packing, WithTheExtremesOfItsRanges) {
  PackOptions options = small_options(GetParam());
  options.count = 300;
  for (const float distribution : {0.0f, 1.0f, 8.0f})
    for (const glm::vec2 radius : {glm::vec2(1e-30f, 1), glm::vec2(2, 2), glm::vec2(0.5f, 25)}) {
      options.distribution = distribution;
      options.radius = radius;
      const Tank tank = packed(options);
      EXPECT_EQ(tank.spheres.size(), 300u) << distribution << " " << radius.x;
      expect_packed(tank);
    }
}

/// Number of spheres with radii above r, relative to all: the integral of r^-p from r to the largest.
double fraction_above(double r, double low, double high, double power) {
  const auto integral = [&](double from) {
    return power == 1 ? std::log(high / from)
                      : (std::pow(from, 1 - power) - std::pow(high, 1 - power)) / (power - 1);
  };
  return integral(r) / integral(low);
}

TEST(PackRadii, FollowThePowerLaw) {
  PackOptions options;
  options.size = {1000, 500, 500};
  options.count = 20000;
  options.radius = {0.5f, 5};
  for (const Arrangement arrangement : {Arrangement::random, Arrangement::largest_first})
    for (const float power : {0.0f, 1.0f, 3.0f}) {
      options.arrangement = arrangement;
      options.distribution = power;
      const Tank tank = packed(options);
      ASSERT_EQ(tank.spheres.size(), options.count);
      std::vector<double> radii;
      for (const Sphere& sphere : tank.spheres) radii.push_back(double{sphere.radius});
      std::sort(radii.begin(), radii.end());
      // A hundredth of the tank (power 3) up to a quarter (power 0) is full: a place for the whole radius is
      // found within 24 attempts, but for a fraction of spheres below 0.9^24 = 0.08 where the probability of
      // an attempt is a tenth. Independent radii are within sqrt(ln(2 / a) / 2n) of their distribution but
      // for a probability a (Dvoretzky, Kiefer and Wolfowitz; Massart 1990), here of 1e-9; stratified ones
      // within 1 / n.
      const double n = options.count;
      const double bound = arrangement == Arrangement::random ? std::sqrt(std::log(2e9) / (2 * n)) : 1.5 / n;
      double worst = 0;
      for (std::size_t i = 0; i < radii.size(); ++i) {
        const double below = 1 - fraction_above(radii[i], 0.5, 5, double{power});
        worst = std::max(worst, std::abs(below - (static_cast<double>(i) + 0.5) / n));
      }
      EXPECT_LE(worst, bound) << "power " << power;
    }
}

TEST(PackColors, AreThoseOfThePaletteAndHaveTheOpacity) {
  PackOptions options = small_options(Arrangement::random);
  options.opacity = 0.5f;
  const Tank tank = packed(options);
  std::set<Color> colors;
  for (const Color color : tank.colors) {
    EXPECT_EQ(color >> 24, 128u);
    colors.insert(color & 0xffffff);
  }
  EXPECT_EQ(colors, std::set<Color>(options.palette.begin(), options.palette.end()));
  options.palette.clear();
  options.opacity = 1;
  EXPECT_EQ(packed(options).colors.front(), 0xffffffffu);
}

/// Place of each sphere's colour on a palette whose colours count up.
std::vector<double> palette_places(PackOptions options, Coloring coloring) {
  options.coloring = coloring;
  options.palette.resize(1001);
  for (Color i = 0; i < 1001; ++i) options.palette[i] = i;
  std::vector<double> places;
  for (const Color color : packed(options).colors) places.push_back((color & 0xffffff) / 1000.0);
  return places;
}

TEST(PackColors, FollowRadiusAndHeight) {
  PackOptions options = small_options(Arrangement::largest_first);
  const Tank tank = packed(options);
  const auto by_radius = palette_places(options, Coloring::radius);
  const auto by_height = palette_places(options, Coloring::height);
  ASSERT_GT(tank.spheres.size(), 100u);
  for (std::size_t i = 0; i < tank.spheres.size(); ++i) {
    const Sphere& sphere = tank.spheres[i];
    // To both sides, 8 % of the palette and half a colour.
    const double radius =
        std::log(sphere.radius / options.radius.x) / std::log(options.radius.y / options.radius.x);
    ASSERT_NEAR(by_radius[i], radius, 0.081);
    ASSERT_NEAR(by_height[i], sphere.center.y / static_cast<float>(options.size.y), 0.081);
  }
  // One radius has no range.
  options.radius = {2, 2};
  for (const double place : palette_places(options, Coloring::radius)) ASSERT_NEAR(place, 0.5, 0.081);
}

TEST(PackColors, OfNoiseAreAlikeNearbyAndDifferFarAway) {
  PackOptions options;
  options.size = {300, 300, 300};
  options.count = 4000;
  options.noise_size = 60;
  const Tank tank = packed(options);
  const auto places = palette_places(options, Coloring::noise);
  double near = 0, far = 0;
  std::size_t near_count = 0, far_count = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t k = i + 1; k < places.size(); k += 7) {
      const float distance = glm::distance(tank.spheres[i].center, tank.spheres[k].center);
      const double difference = std::abs(places[i] - places[k]);
      if (distance < 12) near += difference, ++near_count;
      if (distance > 120) far += difference, ++far_count;
    }
  ASSERT_GT(near_count, 100u);
  // The slope of gradient noise is below 2 a cell, a fifth of which changes the place by 0.4 at most; on
  // average by far less than values of cells apart, which share nothing.
  EXPECT_LT(near / static_cast<double>(near_count), 0.6 * far / static_cast<double>(far_count));
  const auto [least, most] = std::ranges::minmax(places);
  EXPECT_LT(least, 0.15);
  EXPECT_GT(most, 0.85);
}

TEST(PackOrders, LargestFirstHasFallingRadii) {
  // 1,500 spheres of a fill without need to shrink them; those of one round come in its order.
  PackOptions options = small_options(Arrangement::largest_first);
  options.count = 1500;
  const Tank tank = packed(options);
  double before = 0, after = 0;
  for (std::size_t i = 0; i < 750; ++i) {
    before += double{tank.spheres[i].radius};
    after += double{tank.spheres[750 + i].radius};
  }
  EXPECT_GT(before, 1.5 * after);
  EXPECT_GT(tank.spheres.front().radius, 0.9f * options.radius.y);
}

TEST(PackOrders, CoralTouchesWhatIsThereOrTheFloor) {
  const PackOptions options = small_options(Arrangement::coral);
  const Tank tank = packed(options);
  // Both roundings of a centre: the offset that allows for them, and their own length, at most sqrt(3) / 2 of
  // the distance of floats at 150 voxels, 2^-16.
  constexpr double kTouch = (1 + 0.87) * 0x1p-16;
  std::size_t seeds = 0;
  for (std::size_t i = 0; i < tank.spheres.size(); ++i) {
    const Sphere& a = tank.spheres[i];
    if (a.center.y == a.radius) {
      ++seeds;
      continue;
    }
    double nearest = std::numeric_limits<double>::infinity();
    for (std::size_t j = 0; j < i && nearest > kTouch; ++j) {
      const Sphere& b = tank.spheres[j];
      nearest = std::min(nearest, glm::distance(glm::dvec3(a.center), glm::dvec3(b.center)) -
                                      double{a.radius} - double{b.radius});
    }
    ASSERT_LE(nearest, kTouch) << i;
  }
  EXPECT_GE(seeds, 1u);
  EXPECT_LT(seeds, 50u);
}

TEST(PackOrders, NoiseLeavesCaves) {
  PackOptions options = small_options(Arrangement::noise);
  options.count = 6000;
  const auto empty_cells = [&] {
    std::set<std::array<int, 3>> cells;
    for (const Sphere& sphere : packed(options).spheres) {
      const glm::ivec3 cell(sphere.center / 10.0f);
      cells.insert({cell.x, cell.y, cell.z});
    }
    return 15 * 10 * 5 - static_cast<int>(cells.size());
  };
  const int noise = empty_cells();
  options.arrangement = Arrangement::random;
  // Eight spheres a cell, if anywhere: 750 exp(-8) = 0.25 cells are empty on average.
  EXPECT_LE(empty_cells(), 8);
  EXPECT_GT(noise, 75);
}

TEST(PackOptionsCheck, NamesTheMemberAndItsRange) {
  const auto fault = [](const std::function<void(PackOptions&)>& change) {
    PackOptions options;
    change(options);
    const auto tank = pack(options);
    if (tank) return std::string("packed");
    EXPECT_EQ(tank.failure().code, ErrorCode::usage);
    return tank.failure().message;
  };
  const float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(fault([](PackOptions& o) { o.size.y = 0; }),
            "size: 600x0x200 voxels; expected 1 to 2048 along each axis");
  EXPECT_EQ(fault([](PackOptions& o) { o.size = glm::uvec3(2048); }),
            "size: 2048x2048x2048 voxels; expected at most 268435456 in all");
  EXPECT_EQ(fault([](PackOptions& o) { o.voxel = 0; }), "voxel: 0; expected a finite edge above 0");
  EXPECT_EQ(fault([](PackOptions& o) { o.count = 1000000000; }),
            "count: 1000000000 spheres; expected 0 to 8388608");
  EXPECT_EQ(fault([](PackOptions& o) {
              o.radius = {5, 2};
            }),
            "radius: from 5 to 2 voxels; expected 0 < least <= largest <= 100, which is half of the tank's "
            "shortest side");
  for (const glm::vec2 radius : {glm::vec2(-1, 2), glm::vec2(0, 2), glm::vec2(1, 101), glm::vec2(nan, 2),
                                 glm::vec2(1, nan), glm::vec2(1, std::numeric_limits<float>::infinity())})
    EXPECT_EQ(fault([&](PackOptions& o) { o.radius = radius; }).rfind("radius: ", 0), 0u);
  EXPECT_EQ(fault([](PackOptions& o) { o.distribution = 9; }), "distribution: 9; expected 0 to 8");
  EXPECT_EQ(fault([&](PackOptions& o) { o.noise_size = nan; }), "noise_size: nan; expected 1 to 65536");
  EXPECT_EQ(fault([](PackOptions& o) { o.opacity = 1.5f; }), "opacity: 1.5; expected 0 to 1");
  EXPECT_EQ(fault([](PackOptions& o) { o.arrangement = Arrangement(7); }).rfind("arrangement: ", 0), 0u);
}

TEST(PackProgress, IsThatOfSpheres) {
  PackOptions options = small_options(Arrangement::random);
  std::atomic<std::uint64_t> most{0}, total{0};
  static_cast<void>(pack(options, [&] {
    if (const auto state = progress_to_show(0); state && state->name == "pack spheres") {
      most = std::max<std::uint64_t>(most, state->done);
      total = state->total;
    }
    return false;
  }));
  EXPECT_EQ(total, options.count);
  EXPECT_GT(most, 0u);
}

TEST(Pack, DefaultsFitTheTank) {
  const PackOptions usual;
  EXPECT_EQ(default_radius(usual.size), usual.radius);
  EXPECT_EQ(default_count(usual), usual.count);
  for (const glm::uvec3 size :
       {glm::uvec3(1), glm::uvec3(7, 3, 1), glm::uvec3(600, 600, 20), glm::uvec3(40)}) {
    PackOptions options;
    options.size = size;
    options.radius = default_radius(size);
    options.count = default_count(options);
    EXPECT_GE(options.count, 1u);
    EXPECT_TRUE(check_options(options)) << size.x;
  }
}

// The count times the mean volume of the radii of the power law, by the midpoint rule over its quantiles, is
// a third of the tank.
TEST(Pack, TheDefaultCountFillsAThird) {
  for (const float power : {0.0f, 1.0f, 2.5f, 4.0f, 8.0f}) {
    PackOptions options;
    options.size = {300, 200, 100};
    options.radius = {4, 16};
    options.distribution = power;
    // Integrals of r^(3 - power) and r^-power.
    double cubes = 0, all = 0;
    constexpr int kSteps = 10'000;
    for (int i = 0; i < kSteps; ++i) {
      const double radius = 4 + 12 * (i + 0.5) / kSteps, weight = std::pow(radius, -double{power});
      cubes += weight * radius * radius * radius;
      all += weight;
    }
    const double fitting = 6e6 / 3 / (4.0 / 3 * std::acos(-1.0) * cubes / all);
    // The midpoint rule errs by less than (12 / kSteps / 4)^2 of the integral, and the count is whole.
    EXPECT_NEAR(default_count(options), fitting, 1 + 1e-6 * fitting) << power;
  }
  PackOptions equal;
  equal.size = glm::uvec3(100);
  equal.radius = {5, 5};
  EXPECT_EQ(default_count(equal), 636u);  // 1e6 / 3 / (4 / 3 pi 125)
}

}  // namespace
}  // namespace brume::spheres
