#include "image/texels.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "shared/tone.h"

namespace brume::image {
namespace {

constexpr Display kPlain{1, shared::kToneStandard};

Texels one(glm::vec4 texel) {
  return {1, 1, {texel}};
}

void expect_near(glm::vec4 a, glm::vec4 b) {
  for (int c = 0; c < 4; ++c) EXPECT_NEAR(a[c], b[c], 1e-6) << c;
}

TEST(Texels, AreTheColorsOfLayersAndTheirAlpha) {
  const LayeredImage picture{1,
                             1,
                             {{"A", std::vector<float>{0.5f}},
                              {"B", std::vector<float>{3}},
                              {"R", std::vector<std::uint16_t>{0x3c00}}}};
  expect_near(to_texels(picture).rgba.front(), {1, 0, 3, 0.5f});
}

TEST(Texels, StraightColorsAreDividedByAlpha) {
  expect_near(displayed_straight(one({0.1f, 0.2f, 0.05f, 0.5f}), kPlain).rgba.front(),
              {0.2f, 0.4f, 0.1f, 0.5f});
  expect_near(displayed_straight(one({0.1f, 0.2f, 0.05f, 0.5f}), {2, shared::kToneStandard}).rgba.front(),
              {0.4f, 0.8f, 0.2f, 0.5f});
}

// What is brighter than white times its alpha is there over black all the same: alpha is raised for it.
TEST(Texels, WhatGlowsIsThereWhereAlphaIsNot) {
  expect_near(displayed_straight(one({0.5f, 0.25f, 0, 0}), kPlain).rgba.front(), {1, 0.5f, 0, 0.5f});
  expect_near(displayed_straight(one({5, 0.5f, 0, 0.1f}), kPlain).rgba.front(), {1, 0.5f, 0, 1});
  expect_near(displayed(one({0.5f, 0.25f, 0, 0}), kPlain).rgba.front(), {0.5f, 0.25f, 0, 0});
  expect_near(displayed_straight(one({0, 0, 0, 0}), kPlain).rgba.front(), glm::vec4(0));
}

// Over black, straight and premultiplied colours are one picture.
TEST(Texels, BothFormsAreOnePictureOverBlack) {
  for (const std::uint32_t tone : {shared::kToneStandard, shared::kToneNeutral}) {
    for (int i = 0; i < 1000; ++i) {
      const float a = static_cast<float>(i % 10) / 9;
      const glm::vec4 texel(0.003f * static_cast<float>(i), 0.1f * static_cast<float>(i % 7), 0.5f, a);
      const glm::vec4 straight = displayed_straight(one(texel), {1, tone}).rgba.front();
      const glm::vec4 premultiplied = displayed(one(texel), {1, tone}).rgba.front();
      expect_near(glm::vec4(glm::vec3(straight) * straight.a, 0), glm::vec4(glm::vec3(premultiplied), 0));
      EXPECT_GE(straight.a, premultiplied.a);
    }
  }
}

TEST(Texels, NotANumberAndInfinityBecomeColors) {
  const float infinity = std::numeric_limits<float>::infinity();
  const Texels shown = displayed_straight(one({infinity, 1, 0, 1}), kPlain);
  expect_near(shown.rgba.front(), {1, 1, 0, 1});
}

TEST(Texels, TransparentTexelsContinueThoseAroundThem) {
  Texels row{5, 1, {{0, 0, 0, 0}, {1, 0, 0, 1}, {0, 0, 0, 0}, {0, 0, 0, 0}, {0, 0, 0, 0}}};
  fill_transparent(row);
  for (const glm::vec4& texel : row.rgba) expect_near(glm::vec4(glm::vec3(texel), 1), {1, 0, 0, 1});
  EXPECT_EQ(row.rgba[0].a, 0);
  EXPECT_EQ(row.rgba[1].a, 1);
  // What is all but transparent takes their colour, and keeps its alpha.
  Texels rim{2, 1, {{1, 0.5f, 0, 1}, {0.1f, 0, 0.3f, 0.004f}}};
  fill_transparent(rim);
  expect_near(rim.rgba[1], {1, 0.5f, 0, 0.004f});
  Texels nothing{3, 7, std::vector<glm::vec4>(21, glm::vec4(0))};
  fill_transparent(nothing);
  EXPECT_EQ(nothing.rgba, std::vector<glm::vec4>(21, glm::vec4(0)));
}

TEST(Texels, ColorsAreOfSrgb) {
  const Image8 image = to_colors(Texels{2, 1, {{0.2140411f, 0, 1, 0.5f}, {2, -1, 0, 1}}});
  EXPECT_EQ(image.rgba, (std::vector<std::uint8_t>{127, 0, 255, 128, 255, 0, 0, 255}));
}

}  // namespace
}  // namespace brume::image
