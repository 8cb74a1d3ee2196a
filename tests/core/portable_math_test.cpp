// Against the C library in long double, whose error is far smaller than the bounds.
#include "core/portable_math.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

namespace brume::portable {
namespace {

TEST(PortableMath, ExpIsThatOfTheLibrary) {
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> exponents(-700, 700), small(-1, 1);
  for (int i = 0; i < 200000; ++i) {
    const double x = i % 2 == 0 ? exponents(random) : small(random);
    const long double expected = std::exp(static_cast<long double>(x));
    ASSERT_LE(std::abs(exp(x) - expected), 1e-14L * expected) << x;
  }
  EXPECT_EQ(exp(0), 1);
  EXPECT_EQ(exp(-1e300), 0);
  EXPECT_EQ(exp(1e300), HUGE_VAL);
  EXPECT_TRUE(std::isnan(exp(std::nan(""))));
}

TEST(PortableMath, LogAndPowAreThoseOfTheLibrary) {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> exponents(-300, 300), near(0.5, 2), powers(-3, 3);
  for (int i = 0; i < 200000; ++i) {
    const double x = i % 2 == 0 ? std::exp(exponents(random)) : near(random);
    const long double expected = std::log(static_cast<long double>(x));
    // Around 1 the logarithm is as exact as x - 1 is.
    ASSERT_LE(std::abs(log(x) - expected), 1e-14L * std::abs(expected)) << x;
    const double y = powers(random), base = near(random);
    const long double power = std::pow(static_cast<long double>(base), static_cast<long double>(y));
    ASSERT_LE(std::abs(pow(base, y) - power), 1e-14L * power) << base << " " << y;
  }
  EXPECT_EQ(log(1), 0);
  EXPECT_EQ(pow(1, 0.8), 1);
}

TEST(PortableMath, SineAndCosineAreThoseOfTheLibrary) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> turns(-3, 3);
  for (int i = 0; i < 200000; ++i) {
    const double t = turns(random);
    const long double angle = 2 * std::numbers::pi_v<long double> * static_cast<long double>(t);
    const auto [sine, cosine] = sine_cosine_of_turns(t);
    ASSERT_NEAR(sine, static_cast<double>(std::sin(angle)), 1e-15) << t;
    ASSERT_NEAR(cosine, static_cast<double>(std::cos(angle)), 1e-15) << t;
  }
  for (int quarter = -8; quarter <= 8; ++quarter) {
    const auto [sine, cosine] = sine_cosine_of_turns(0.25 * quarter);
    constexpr int kSines[4] = {0, 1, 0, -1};
    EXPECT_EQ(sine, kSines[quarter & 3]);
    EXPECT_EQ(cosine, kSines[(quarter + 1) & 3]);
  }
}

}  // namespace
}  // namespace brume::portable
