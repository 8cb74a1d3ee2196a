#include "palettes/sample.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "palettes/oklab.hpp"

namespace brume::palettes {
namespace {

using Vec = glm::dvec3;

/// Oklab as the page of its author has it in scalars, and its inverse by elimination: independent of the
/// matrices of the library and of their published inverses.
struct PlainOklab {
  static constexpr double kCones[3][3] = {{0.4122214708, 0.5363325363, 0.0514459929},
                                          {0.2119034982, 0.6806995451, 0.1073969566},
                                          {0.0883024619, 0.2817188376, 0.6299787005}};
  static constexpr double kLab[3][3] = {{0.2104542553, 0.7936177850, -0.0040720468},
                                        {1.9779984951, -2.4285922050, 0.4505937099},
                                        {0.0259040371, 0.7827717662, -0.8086757660}};

  static Vec times(const double (&m)[3][3], const Vec& v) {
    Vec r(0);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) r[i] += m[i][j] * v[j];
    return r;
  }

  static Vec solve(const double (&m)[3][3], const Vec& right) {
    double a[3][4];
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) a[i][j] = m[i][j];
      a[i][3] = right[i];
    }
    for (int p = 0; p < 3; ++p)
      for (int i = 0; i < 3; ++i) {
        if (i == p) continue;
        const double factor = a[i][p] / a[p][p];
        for (int j = p; j < 4; ++j) a[i][j] -= factor * a[p][j];
      }
    return {a[0][3] / a[0][0], a[1][3] / a[1][1], a[2][3] / a[2][2]};
  }

  static Vec lab(const Vec& linear) {
    const Vec c = times(kCones, linear);
    return times(kLab, Vec(std::pow(c.x, 1 / 3.0), std::pow(c.y, 1 / 3.0), std::pow(c.z, 1 / 3.0)));
  }

  static Vec linear(const Vec& lab) {
    const Vec r = solve(kLab, lab);
    return solve(kCones, Vec(r.x * r.x * r.x, r.y * r.y * r.y, r.z * r.z * r.z));
  }
};

double channel_to_linear(double x) {
  return x > 0.04045 ? std::exp(2.4 * std::log((x + 0.055) / 1.055)) : x / 12.92;
}

double channel_to_srgb(double x) {
  x = std::min(std::max(x, 0.0), 1.0);
  return x > 0.0031308 ? 1.055 * std::exp(std::log(x) / 2.4) - 0.055 : 12.92 * x;
}

Vec to_linear(const Vec& c) {
  return {channel_to_linear(c.x), channel_to_linear(c.y), channel_to_linear(c.z)};
}

Vec to_srgb(const Vec& c) {
  return {channel_to_srgb(c.x), channel_to_srgb(c.y), channel_to_srgb(c.z)};
}

double largest(const Vec& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

Palette pair_of(const glm::u8vec3& a, const glm::u8vec3& b) {
  return {"pair", "", Kind::gradient, {a, b}};
}

TEST(Oklab, HasTheValuesOfTheStandard) {
  // CSS Color 4, section 17: sRGB's white, red, lime and blue, to five digits.
  EXPECT_LT(largest(oklab_from_linear({1, 1, 1}) - Vec(1, 0, 0)), 1e-5);
  EXPECT_LT(largest(oklab_from_linear({1, 0, 0}) - Vec(0.62796, 0.22486, 0.12585)), 1e-5);
  EXPECT_LT(largest(oklab_from_linear({0, 1, 0}) - Vec(0.86644, -0.23389, 0.17950)), 1e-5);
  EXPECT_LT(largest(oklab_from_linear({0, 0, 1}) - Vec(0.45201, -0.03246, -0.31153)), 1e-5);
  EXPECT_EQ(oklab_from_linear({0, 0, 0}), Vec(0));
}

TEST(Oklab, AgreesWithItsScalarForm) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const Vec linear(unit(random), unit(random), unit(random));
    // A few dozen roundings of 1e-16 of values up to 5.
    EXPECT_LT(largest(oklab_from_linear(linear) - PlainOklab::lab(linear)), 1e-13);
  }
}

TEST(Oklab, ReturnsWhatItWasGiven) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const Vec linear(unit(random), unit(random), unit(random));
    // Ten digits of the matrices and of their published inverses, whose entries are at most 5: each of two
    // products is off by at most 3 * 5 * 1e-10, which the cube and the last matrix multiply by 3 * 3 * 5.
    EXPECT_LT(largest(linear_from_oklab(oklab_from_linear(linear)) - linear), 1e-6);
    EXPECT_LT(largest(linear_from_srgb(srgb_from_linear(linear)) - linear), 1e-12);
  }
}

TEST(Samples, BetweenColoursLieOnALineOfTheirSpace) {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> byte(0, 255);
  std::uniform_real_distribution<double> unit(0, 1);
  for (int i = 0; i < 2000; ++i) {
    const auto any = [&] { return glm::u8vec3(byte(random), byte(random), byte(random)); };
    const glm::u8vec3 first = any(), last = any();
    const Palette palette = pair_of(first, last);
    const double t = unit(random);
    const Vec a = Vec(first) / 255.0, b = Vec(last) / 255.0;
    EXPECT_LT(largest(sample(palette, t, Space::srgb) - ((1 - t) * a + t * b)), 1e-12);
    const Vec linear = (1 - t) * to_linear(a) + t * to_linear(b);
    EXPECT_LT(largest(sample(palette, t, Space::linear) - to_srgb(linear)), 1e-9);
    // The 1e-6 of the inverse above, times the largest slope of the encoding.
    const Vec lab = (1 - t) * PlainOklab::lab(to_linear(a)) + t * PlainOklab::lab(to_linear(b));
    EXPECT_LT(largest(sample(palette, t) - to_srgb(PlainOklab::linear(lab))), 12.92e-6);
  }
}

TEST(Samples, AreThePalettesOwnColoursAtTheirPositions) {
  const Palette palette{
      "p", "", Kind::gradient, {{1, 2, 3}, {250, 0, 7}, {0, 99, 255}, {17, 17, 17}, {3, 2, 1}}};
  for (const Space space : {Space::oklab, Space::linear, Space::srgb, Space::nearest}) {
    for (std::size_t i = 0; i < 5; ++i)
      EXPECT_EQ(sample_byte(palette, static_cast<double>(i) / 4, space), palette.colors[i]);
    EXPECT_EQ(sample_byte(palette, -1, space), palette.colors.front());
    EXPECT_EQ(sample_byte(palette, 2, space), palette.colors.back());
  }
}

TEST(Samples, OfTheNearestHaveEqualPartsOfThePalette) {
  const Palette palette{"p", "", Kind::qualitative, {{1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}};
  for (int i = 0; i < 4000; ++i) {
    const double at = (i + 0.5) / 4000;
    EXPECT_EQ(sample_byte(palette, at, Space::nearest).x, 1 + i / 1000);
  }
}

TEST(Samples, InOklabOfGreysStayGrey) {
  const Palette palette = pair_of({0, 0, 0}, {255, 255, 255});
  for (int i = 0; i <= 64; ++i) {
    const glm::u8vec3 c = sample_byte(palette, i / 64.0);
    EXPECT_EQ(c.x, c.y);
    EXPECT_EQ(c.y, c.z);
  }
}

TEST(Ranges, AreBytesFromTheLowToTheHighEnd) {
  const Palette palette = pair_of({0, 0, 0}, {100, 200, 40});
  const auto colors = sample_range(palette, 0, 1, 5, Space::srgb);
  ASSERT_EQ(colors.size(), 5u);
  EXPECT_EQ(colors.front(), 0u);
  EXPECT_EQ(colors[2], 50u | 100u << 8 | 20u << 16) << "red is the lowest byte, no opacity";
  EXPECT_EQ(colors.back(), 100u | 200u << 8 | 40u << 16);
  const auto backwards = sample_range(palette, 1, 0, 5, Space::srgb);
  EXPECT_TRUE(std::equal(colors.begin(), colors.end(), backwards.rbegin()));
  EXPECT_EQ(sample_range(palette, 0.5, 0.5, 2, Space::srgb),
            (std::vector<std::uint32_t>{colors[2], colors[2]}));
  EXPECT_EQ(sample_range(palette, 0, 1, 1, Space::srgb), (std::vector<std::uint32_t>{colors[2]}));
  EXPECT_TRUE(sample_range(palette, 0, 1, 0).empty());
}

TEST(Spaces, HaveNames) {
  EXPECT_EQ(space_of("oklab"), Space::oklab);
  EXPECT_EQ(space_of("linear"), Space::linear);
  EXPECT_EQ(space_of("srgb"), Space::srgb);
  EXPECT_EQ(space_of("nearest"), Space::nearest);
  EXPECT_FALSE(space_of("rgb"));
}

}  // namespace
}  // namespace brume::palettes
