#include "image/metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "tests/image/image_test_tools.hpp"

namespace brume::image {
namespace {

Image8 filled(std::uint32_t width, std::uint32_t height, glm::u8vec3 colour) {
  Image8 image{width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i)
    image.rgba.insert(image.rgba.end(), {colour.r, colour.g, colour.b, 255});
  return image;
}

double mean(const Plane& plane) {
  double sum = 0;
  for (const float value : plane.values) sum += double{value};
  return sum / static_cast<double>(plane.values.size());
}

TEST(Difference, OfKnownLists) {
  const std::vector<float> a{0, 1, 2, 3}, b{0, 3, 2, -1};
  const Difference d = difference(a, b);
  EXPECT_EQ(d.max, 4);
  EXPECT_EQ(d.mean, 1.5);
  EXPECT_DOUBLE_EQ(d.rmse, std::sqrt(5));
  EXPECT_EQ(difference(a, a).max, 0);
  EXPECT_EQ(difference({}, {}).rmse, 0);
  EXPECT_DOUBLE_EQ(psnr(1, 100), 40);
  EXPECT_EQ(psnr(0, 1), std::numeric_limits<double>::infinity());
  const std::vector<float> broken{std::numeric_limits<float>::quiet_NaN()}, fine{1};
  EXPECT_EQ(difference(broken, fine).rmse, std::numeric_limits<double>::infinity());
  EXPECT_EQ(difference(broken, broken).max, std::numeric_limits<double>::infinity());
}

TEST(Ssim, OfPlanesWithoutStructureIsTheirLuminanceTerm) {
  // Both variances are 0: what remains is (2 a b + C1) / (a^2 + b^2 + C1), C1 = 0.01^2.
  for (const auto& [w, h] : {std::pair{33u, 17u}, {7u, 5u}, {1u, 1u}, {11u, 40u}}) {
    const Plane a{w, h, std::vector<float>(w * h, 0.25f)}, b{w, h, std::vector<float>(w * h, 0.75f)};
    EXPECT_NEAR(ssim(a, b, 1), (2 * 0.25 * 0.75 + 1e-4) / (0.25 * 0.25 + 0.75 * 0.75 + 1e-4), 1e-12);
    EXPECT_NEAR(ssim(a, a, 1), 1, 1e-12);
  }
}

TEST(Ssim, OfOneWindowMatchesTheFormula) {
  // One window, 11 x 11: the sums written out.
  std::mt19937 random(3);
  std::uniform_real_distribution<float> level(0, 1);
  Plane a{11, 11, {}}, b{11, 11, {}};
  for (int i = 0; i < 121; ++i) {
    a.values.push_back(level(random));
    b.values.push_back(level(random));
  }
  double weights[121], total = 0, ma = 0, mb = 0;
  for (int i = 0; i < 121; ++i) {
    const double x = i % 11 - 5, y = i / 11 - 5;
    total += weights[i] = std::exp(-(x * x + y * y) / (2 * 1.5 * 1.5));
  }
  for (std::size_t i = 0; i < 121; ++i) {
    ma += weights[i] / total * double{a.values[i]};
    mb += weights[i] / total * double{b.values[i]};
  }
  double va = 0, vb = 0, ab = 0;
  for (std::size_t i = 0; i < 121; ++i) {
    const double da = double{a.values[i]} - ma, db = double{b.values[i]} - mb;
    va += weights[i] / total * da * da;
    vb += weights[i] / total * db * db;
    ab += weights[i] / total * da * db;
  }
  const double expected =
      (2 * ma * mb + 1e-4) * (2 * ab + 9e-4) / ((ma * ma + mb * mb + 1e-4) * (va + vb + 9e-4));
  EXPECT_NEAR(ssim(a, b, 1), expected, 1e-12);
  EXPECT_NEAR(ssim(b, a, 1), expected, 1e-12);
  // The negative has the greatest difference.
  Plane negative = a;
  for (float& value : negative.values) value = 1 - value;
  EXPECT_LT(ssim(a, negative, 1), -0.8);
}

TEST(Flip, IsZeroForEqualImages) {
  for (const auto& [w, h] : {std::pair{33u, 17u}, {1u, 1u}, {7u, 1u}}) {
    const Image8 image = random_image(w, h, true, 5);
    for (const float value : flip(image, image).values) EXPECT_EQ(value, 0);
  }
}

TEST(Flip, OfPlainImagesIsTheColourDifference) {
  // Filters do not change plain images, and there are no features. Black and white are 100 apart in
  // lightness, so 100^0.7 = 25.119 of the 308.3^0.7 = 55.2 or so between green and blue; worked out here from
  // CIELAB again.
  const auto lab = [](double x, double y, double z) {  // relative to white, all far above the dark end
    const double l = 116 * std::cbrt(y) - 16;
    return glm::dvec3(l, 0.01 * l * 500 * (std::cbrt(x) - std::cbrt(y)),
                      0.01 * l * 200 * (std::cbrt(y) - std::cbrt(z)));
  };
  const glm::dvec3 white(23359437.0 / 24577794, 1, 80288307.0 / 73733382);
  const glm::dvec3 green =
      lab(8788810.0 / 24577794 / white.x, 8788810.0 / 12288897, 8788810.0 / 73733382 / white.z);
  const glm::dvec3 blue =
      lab(4435075.0 / 24577794 / white.x, 887015.0 / 12288897, 70074185.0 / 73733382 / white.z);
  const double most =
      std::pow(std::abs(green.x - blue.x) + std::hypot(green.y - blue.y, green.z - blue.z), 0.7);
  const auto expected = [&](double apart) {
    const double d = std::pow(apart, 0.7), bend = 0.4 * most;
    return d < bend ? 0.95 / bend * d : 0.95 + (d - bend) / (most - bend) * 0.05;
  };
  const Image8 black = filled(40, 23, {0, 0, 0}), grey = filled(40, 23, {119, 119, 119});
  EXPECT_NEAR(mean(flip(black, filled(40, 23, {255, 255, 255}))), expected(100), 1e-6);
  const double y = std::pow((119 / 255.0 + 0.055) / 1.055, 2.4);
  EXPECT_NEAR(mean(flip(black, grey)), expected(116 * std::cbrt(y) - 16), 1e-6);
  EXPECT_NEAR(mean(flip(filled(40, 23, {0, 255, 0}), filled(40, 23, {0, 0, 255}))), 1, 1e-6);
}

TEST(Flip, LocatesALineAndFadesWithDistance) {
  const Image8 plain = filled(64, 64, {128, 128, 128});
  Image8 line = plain;
  for (std::uint32_t y = 0; y < 64; ++y)
    for (std::uint32_t c = 0; c < 3; ++c) line.rgba[4 * (y * 64 + 32) + c] = 160;
  const auto along = [&](double pixels_per_degree) {
    const Plane map = flip(plain, line, pixels_per_degree);
    for (std::uint32_t x = 0; x < 32; ++x)
      EXPECT_NEAR(map.values[32 * 64 + 32 - x], map.values[32 * 64 + 32 + x], 1e-6);
    EXPECT_LT(map.values[32u * 64 + 2], 0.2f * map.values[32u * 64 + 32]);
    return map.values[32u * 64 + 32];
  };
  EXPECT_GT(along(20), 1.5f * along(67));
}

TEST(Flip, IsSymmetricAndAtMostOne) {
  const Image8 a = random_image(33, 17, true, 1), b = random_image(33, 17, true, 2);
  const Plane there = flip(a, b), back = flip(b, a);
  for (std::size_t i = 0; i < there.values.size(); ++i) {
    EXPECT_EQ(there.values[i], back.values[i]);
    EXPECT_GE(there.values[i], 0);
    EXPECT_LE(there.values[i], 1);
  }
}

TEST(HeatMap, GetsBrighter) {
  Plane ramp{256, 1, {}};
  for (int i = 0; i < 256; ++i) ramp.values.push_back(static_cast<float>(i) / 255);
  const Image8 image = heat_map(ramp);
  const Plane light = luma(image);
  for (std::size_t i = 1; i < 256; ++i) EXPECT_GE(light.values[i] + 0.004f, light.values[i - 1]) << i;
  EXPECT_EQ(light.values[0], 0);
  EXPECT_GT(light.values[255], 0.9f);
}

}  // namespace
}  // namespace brume::image
