#include "apps/viewer/quality.hpp"

#include <gtest/gtest.h>

namespace brume::viewer {
namespace {

/// Plays a machine whose levels take so long [s], for some seconds; the levels that it was at.
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

TEST(QualityTest, StaysAtTheBestWhereThereIsTime) {
  QualityControl control(60);
  for (const std::size_t level : play(control, {0.004, 0.003, 0.002, 0.001, 0.001, 0.001}, 20))
    EXPECT_EQ(level, 0u);
}

TEST(QualityTest, FindsTheFirstLevelThatHoldsTheRate) {
  QualityControl control(8);
  play(control, {1.2, 0.7, 0.5, 0.3, 0.11, 0.06}, 10);
  EXPECT_EQ(control.level(), 4u);
}

TEST(QualityTest, ComesBackWhenThereIsTimeAgain) {
  QualityControl control(60);
  play(control, {0.05, 0.03, 0.02, 0.012, 0.01, 0.01}, 5);
  EXPECT_EQ(control.level(), 3u);
  play(control, {0.004, 0.003, 0.002, 0.001, 0.001, 0.001}, 20);
  EXPECT_EQ(control.level(), 0u);
}

TEST(QualityTest, TriesATooSlowLevelMoreAndMoreRarely) {
  QualityControl control(60);
  // Level 1 is cheap enough to invite a try of level 0, which never holds.
  const auto levels = play(control, {0.03, 0.004, 0.004, 0.004, 0.004, 0.004}, 120);
  int tries = 0;
  for (std::size_t i = 1; i < levels.size(); ++i) tries += levels[i] == 0 && levels[i - 1] == 1 ? 1 : 0;
  // Rests of 2, 4, 8, 16, 32, 32... seconds: six within two minutes.
  EXPECT_LE(tries, 6);
  EXPECT_GE(tries, 3);
}

TEST(QualityTest, AFixedLevelStays) {
  QualityControl control(60);
  control.fix(2);
  for (const std::size_t level : play(control, {1, 1, 1, 1, 1, 1}, 5)) EXPECT_EQ(level, 2u);
}

}  // namespace
}  // namespace brume::viewer
