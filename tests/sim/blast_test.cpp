// Blasts in open space against a double-precision model.
#include "sim/blast.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/reference/blast.hpp"

namespace brume::sim {
namespace {

constexpr std::uint32_t kTicks = 64;  // a second
constexpr voxel::GridLayout kFrame{{48, 40, 44}, 0.25f, {0, 0, 0}};

Blast random_blast(std::mt19937& random) {
  const auto between = [&](std::uint32_t low, std::uint32_t high) {
    return low + static_cast<std::uint32_t>(random()) % (high - low + 1);
  };
  Blast blast;
  blast.tick = between(0, 500);
  for (int axis = 0; axis < 3; ++axis) blast.at[axis] = static_cast<std::int32_t>(between(3000, 8000));
  blast.radius = between(1024, 5 * 1024);
  blast.speed = between(4 * 1024, 64 * 1024);
  blast.remaining = between(0, 60);
  blast.refill_rim_ms = between(200, 2000);
  blast.refill_middle_ms = blast.refill_rim_ms + between(0, 5000);
  return blast;
}

/// Bounds of the result of the integer simulation. It rounds distances down to 255 steps of 1.2 radii and
/// times down to milliseconds; it approximates smoothstep^1.8 by a polynomial with an error of 0.018
/// (blast.cpp), and rounds sums of 1/65536 and the remaining density.
std::pair<double, double> allowed(const Blast& blast, double distance, double age) {
  const double step = 1.2 * blast.radius / 1024 / 255 + 2 * 0.25 / 1024;
  std::pair<double, double> range{255, 0};
  for (int i = 0; i <= 8; ++i)
    for (int k = -4; k <= 8; ++k) {
      // Rounding to milliseconds makes the front arrive and the refill end earlier.
      const double left = reference::blast_left(blast, std::max(0.0, distance - step * i / 8),
                                                std::max(0.0, age + 0.002 * k / 8));
      range = {std::min(range.first, left), std::max(range.second, left)};
    }
  const double slack = 0.018 * (255 - blast.remaining) + 1;
  return {range.first - slack, range.second + slack};
}

TEST(Blasts, MatchADoublePrecisionModelAt1000PointsAndTimes) {
  std::mt19937 random(21);
  const voxel::BitGrid open(kFrame);
  int cleared = 0, partly = 0, whole = 0;
  for (int i = 0; i < 100; ++i) {
    const Blast blast = random_blast(random);
    const BlastField field(open, blast, kTicks);
    const glm::dvec3 centre = glm::dvec3(blast.at) / 1024.0;
    for (int k = 0; k < 10; ++k) {
      // A point up to 1.3 radii away, every tenth time at the centre; a time until the end.
      const auto unit = [&] { return static_cast<double>(random() % 65536) / 32768 - 1; };
      const double x = unit(), y = unit(), z = unit();
      const glm::dvec3 aside = k == 0 ? glm::dvec3(0) : glm::dvec3(x, y, z) * (0.75 * blast.radius / 1024.0);
      const glm::ivec3 voxel(glm::floor((centre + aside) / 0.25));
      if (!glm::all(glm::greaterThanEqual(voxel, glm::ivec3(0))) ||
          !glm::all(glm::lessThan(voxel, kFrame.size))) {
        --k;
        continue;
      }
      const std::uint32_t after = static_cast<std::uint32_t>(random()) % (field.end_tick() - blast.tick + 10);
      const std::uint32_t since = k % 3 == 0 ? after % 40 : after;
      const int left = field.remaining(voxel, field.profile(blast.tick + since));
      const double distance = glm::distance((glm::dvec3(voxel) + 0.5) * 0.25, centre);
      const auto [least, most] = allowed(blast, distance, static_cast<double>(since) / kTicks);
      EXPECT_GE(left, least) << i << " " << distance << " " << since;
      EXPECT_LE(left, most) << i << " " << distance << " " << since;
      cleared += left <= static_cast<int>(blast.remaining) + 2;
      whole += left == 255;
      partly += left > static_cast<int>(blast.remaining) + 2 && left < 255;
    }
  }
  EXPECT_GT(cleared, 50);
  EXPECT_GT(partly, 300);
  EXPECT_GT(whole, 100);
}

}  // namespace
}  // namespace brume::sim
