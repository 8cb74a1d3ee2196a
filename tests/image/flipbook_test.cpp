#include "image/flipbook.hpp"

#include <gtest/gtest.h>

namespace brume::image {
namespace {

TEST(Flipbook, TilesAreInRowsFromTheTopLeft) {
  const FlipbookLayout layout{3, 2, {7, 5}, 1};
  EXPECT_EQ(layout.tiles(), 6u);
  EXPECT_EQ(layout.picture_px(), glm::uvec2(5, 3));
  EXPECT_EQ(layout.sheet_px(), glm::uvec2(21, 10));
  Texels sheet = empty_sheet(layout);
  for (std::uint32_t tile = 0; tile < layout.tiles(); ++tile) {
    Texels picture{5, 3, {}};
    for (int i = 0; i < 15; ++i) picture.rgba.emplace_back(tile + 1, i, 0, 1);
    set_tile(layout, tile, with_gutter(picture, layout.gutter), sheet);
  }
  for (std::uint32_t tile = 0; tile < layout.tiles(); ++tile) {
    const Texels one = tile_of(layout, tile, sheet);
    ASSERT_EQ(glm::uvec2(one.width, one.height), layout.tile_px);
    for (std::uint32_t y = 0; y < one.height; ++y) {
      for (std::uint32_t x = 0; x < one.width; ++x) {
        const bool in_gutter = x == 0 || y == 0 || x == 6 || y == 4;
        const glm::vec4 expected = in_gutter ? glm::vec4(0) : glm::vec4(tile + 1, x - 1 + 5 * (y - 1), 0, 1);
        EXPECT_EQ(one.rgba[y * one.width + x], expected) << tile << ": " << x << ", " << y;
      }
    }
  }
  EXPECT_EQ(sheet.rgba[6 * 21 + 15], glm::vec4(6, 0, 0, 1));
}

SixWayLight light_of(std::array<float, kLightSides> values) {
  SixWayLight light;
  for (std::size_t side = 0; side < kLightSides; ++side) light[side] = {values[side]};
  return light;
}

TEST(Flipbook, LightOfASideIsThatOfItsDirection) {
  const SixWayLight light = light_of({1, 2, 3, 4, 5, 6});
  for (std::size_t side = 0; side < kLightSides; ++side)
    EXPECT_FLOAT_EQ(relit(light, 0, direction_of(static_cast<LightSide>(side))),
                    static_cast<float>(side + 1));
  // From the right and behind.
  EXPECT_FLOAT_EQ(relit(light, 0, glm::vec3(0.6f, 0, -0.8f)), 0.36f * 1 + 0.64f * 5);
  // The weights add up to 1.
  EXPECT_FLOAT_EQ(relit(light_of({7, 7, 7, 7, 7, 7}), 0, glm::normalize(glm::vec3(1, -2, 3))), 7);
}

TEST(Flipbook, NormalsPointToWhatIsBright) {
  EXPECT_EQ(normal_of(light_of({1, 1, 2, 2, 0, 3}), 0), glm::vec3(0, 0, 1));
  EXPECT_EQ(normal_of(light_of({0, 0, 0, 0, 0, 0}), 0), glm::vec3(0, 0, 1));
  const glm::vec3 right = normal_of(light_of({3, 1, 1, 1, 0, 0}), 0);
  EXPECT_FLOAT_EQ(right.x, 0.5f);
  EXPECT_FLOAT_EQ(right.y, 0);
  const glm::vec3 corner = normal_of(light_of({1, 0, 0, 1, 0, 0}), 0);
  EXPECT_GT(corner.x, 0.6f);
  EXPECT_LT(corner.y, -0.6f);
  EXPECT_GT(corner.z, 0);
  EXPECT_NEAR(glm::length(corner), 1, 1e-6);
}

}  // namespace
}  // namespace brume::image
