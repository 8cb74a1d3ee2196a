#include "apps/viewer/quality.hpp"

#include <gtest/gtest.h>

namespace brume::viewer {
namespace {

/// Simulates a machine with these frame times by level [s] for some seconds; returns the level of every
/// frame.
std::vector<std::size_t> play(QualityControl& control, const std::vector<double>& costs, double seconds) {
  std::vector<std::size_t> levels;
  for (double time = 0; time < seconds;) {
    const double work = costs[control.level()];
    const double frame = std::max(work, 1.0 / 60);
    levels.push_back(control.level());
    control.add_frame(work, frame);
    time += frame;
  }
  return levels;
}

TEST(QualityTest, LightIsUpdatedInFewerFramesWhereTheseAreSlow) {
  EXPECT_EQ(light_update_fraction(1.0f / 16, 0), 1.0f / 16);
  EXPECT_EQ(light_update_fraction(1.0f / 16, 1.0 / 60), 1.0f / 16);
  EXPECT_NEAR(light_update_fraction(1.0f / 16, 0.15), 3.0f / 16, 1e-6f);
  EXPECT_EQ(light_update_fraction(1.0f / 16, 1e9), 0.25f);
  EXPECT_EQ(light_update_fraction(0.5f, 1e9), 0.5f);
  EXPECT_EQ(light_update_fraction(1, 0.3), 1);
}

TEST(QualityTest, KeepsTheBestLevelIfItIsFastEnough) {
  QualityControl control(60);
  for (const std::size_t level : play(control, {0.004, 0.003, 0.002, 0.001, 0.001, 0.001}, 20))
    EXPECT_EQ(level, 0u);
}

TEST(QualityTest, FindsTheBestLevelThatHoldsTheRate) {
  QualityControl control(8);
  play(control, {1.2, 0.7, 0.5, 0.3, 0.11, 0.06}, 10);
  EXPECT_EQ(control.level(), 4u);
}

TEST(QualityTest, RaisesQualityWhenLoadDrops) {
  QualityControl control(60);
  play(control, {0.05, 0.03, 0.02, 0.012, 0.01, 0.01}, 5);
  EXPECT_EQ(control.level(), 3u);
  play(control, {0.004, 0.003, 0.002, 0.001, 0.001, 0.001}, 20);
  EXPECT_EQ(control.level(), 0u);
}

TEST(QualityTest, RetriesATooSlowLevelLessAndLessOften) {
  QualityControl control(60);
  // Level 1 is fast enough to try level 0, which is always too slow.
  const auto levels = play(control, {0.03, 0.004, 0.004, 0.004, 0.004, 0.004}, 120);
  int tries = 0;
  for (std::size_t i = 1; i < levels.size(); ++i) tries += levels[i] == 0 && levels[i - 1] == 1 ? 1 : 0;
  // Cooldowns of 2, 4, 8, 16, 32, 32... seconds: six within two minutes.
  EXPECT_LE(tries, 6);
  EXPECT_GE(tries, 3);
}

TEST(QualityTest, KeepsAFixedLevel) {
  QualityControl control(60);
  control.fix(2);
  for (const std::size_t level : play(control, {1, 1, 1, 1, 1, 1}, 5)) EXPECT_EQ(level, 2u);
}

}  // namespace
}  // namespace brume::viewer
