#include "smoke/mask_atlas.hpp"

#include <gtest/gtest.h>

#include <random>

namespace brume::smoke {
namespace {

Mask random_mask(std::uint32_t width, std::uint32_t height, std::mt19937& random) {
  Mask mask{width, height, {}};
  for (std::uint32_t i = 0; i < width * height; ++i)
    mask.texels.push_back(static_cast<std::uint8_t>(random() & 255));
  return mask;
}

glm::vec2 within(const MaskRectangle& r, glm::vec2 share) {
  return glm::mix(r.uv_min, r.uv_max, share);
}

TEST(MaskAtlas, GivesBackEachTexelAtItsCentre) {
  std::mt19937 random(1);
  std::vector<Mask> masks;
  for (const auto& [w, h] : {std::pair{1u, 1u}, {7u, 3u}, {64u, 64u}, {33u, 17u}, {1u, 40u}, {100u, 2u}})
    masks.push_back(random_mask(w, h, random));
  const MaskAtlas atlas = MaskAtlas::pack(masks).value_or_throw();
  ASSERT_EQ(atlas.count(), masks.size());
  for (std::uint32_t i = 0; i < masks.size(); ++i)
    for (std::uint32_t y = 0; y < masks[i].height; ++y)
      for (std::uint32_t x = 0; x < masks[i].width; ++x) {
        const glm::vec2 share = (glm::vec2(x, y) + 0.5f) / glm::vec2(masks[i].width, masks[i].height);
        const float expected = static_cast<float>(masks[i].texels[y * masks[i].width + x]) / 255.0f;
        // uv carries 2^-24 of 1, that is 128 * 2^-24 texels, and texels differ by 1 at most; both axes.
        EXPECT_NEAR(atlas.at(within(atlas.rectangle(i), share)), expected, 4e-5f);
      }
}

TEST(MaskAtlas, NeverShowsANeighbourAtTheEdgesOfAMask) {
  std::vector<Mask> masks;
  for (int i = 0; i < 20; ++i) masks.push_back({9, 9, std::vector<std::uint8_t>(81, i % 2 ? 255 : 0)});
  const MaskAtlas atlas = MaskAtlas::pack(masks).value_or_throw();
  for (std::uint32_t i = 0; i < masks.size(); ++i)
    for (float x = 0; x <= 1; x += 0.125f)
      for (const glm::vec2 at : {glm::vec2(x, 0), glm::vec2(x, 1), glm::vec2(0, x), glm::vec2(1, x)})
        EXPECT_EQ(atlas.at(within(atlas.rectangle(i), at)), i % 2 ? 1.0f : 0.0f);
}

TEST(MaskAtlas, CellsAreOfOneKindWithinTheirRadius) {
  // Discs, so that some cells are far from an edge.
  std::mt19937 random(5);
  std::vector<Mask> masks;
  for (const int side : {1, 5, 40, 90}) {
    Mask mask{static_cast<std::uint32_t>(side), static_cast<std::uint32_t>(side), {}};
    for (int i = 0; i < side * side; ++i) {
      const glm::ivec2 from_middle = glm::ivec2(i % side, i / side) - side / 2;
      const int square = from_middle.x * from_middle.x + from_middle.y * from_middle.y;
      const bool soft = square % 97 == 5;
      mask.texels.push_back(static_cast<std::uint8_t>(soft                       ? random() & 255
                                                      : 9 * square < side * side ? 255
                                                                                 : 0));
    }
    masks.push_back(std::move(mask));
  }
  const MaskAtlas atlas = MaskAtlas::pack(masks).value_or_throw();
  const glm::ivec2 size(atlas.width(), atlas.height());
  const auto kind_of = [&](glm::ivec2 v) {
    if (v.x < 0 || v.y < 0 || v.x + 1 >= size.x || v.y + 1 >= size.y) return MaskCell::mixed;
    const std::uint8_t* texel = atlas.texels().data() + v.y * size.x + v.x;
    int black = 0, white = 0;
    for (const int at : {0, 1, size.x, size.x + 1}) black += texel[at] == 0, white += texel[at] == 255;
    return black == 4 ? MaskCell::black : white == 4 ? MaskCell::white : MaskCell::mixed;
  };
  int largest = 0;
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const MaskCell cell = atlas.cell(x, y);
      ASSERT_EQ(cell.kind, kind_of({x, y})) << x << ' ' << y;
      largest = std::max(largest, int{cell.radius});
      if (cell.kind == MaskCell::mixed) {
        EXPECT_EQ(cell.radius, 0);
        continue;
      }
      const int r = cell.radius;
      for (int j = -r; j <= r; ++j)
        for (int i = -r; i <= r; ++i)
          ASSERT_EQ(kind_of({x + i, y + j}), cell.kind) << x << ' ' << y << ' ' << r;
    }
  EXPECT_EQ(largest, kMaxMaskRadius);
}

TEST(MaskAtlas, WithoutMasksIsOneTexelThatRemovesNothing) {
  const MaskAtlas atlas = MaskAtlas::pack({}).value_or_throw();
  EXPECT_EQ(atlas.count(), 0u);
  EXPECT_EQ(atlas.key(), sim::MaskKey{});
  EXPECT_EQ(atlas.at(glm::vec2(0.5f)), 0.0f);
}

TEST(MaskAtlas, HasAKeyThatFollowsFromItsMasks) {
  std::mt19937 random(2);
  std::vector<Mask> masks{random_mask(8, 4, random), random_mask(5, 5, random)};
  const sim::MaskKey key = MaskAtlas::pack(masks).value_or_throw().key();
  EXPECT_EQ(MaskAtlas::pack(masks).value_or_throw().key(), key);
  masks[1].texels[7] ^= 1;
  EXPECT_NE(MaskAtlas::pack(masks).value_or_throw().key(), key);
  masks[1].texels[7] ^= 1;
  std::swap(masks[0].width, masks[0].height);
  EXPECT_NE(MaskAtlas::pack(masks).value_or_throw().key(), key);
}

TEST(MaskAtlas, RefusesWhatDoesNotFit) {
  EXPECT_EQ(MaskAtlas::pack(std::vector<Mask>{{0, 3, {}}}).failure().code, ErrorCode::bad_input);
  EXPECT_EQ(MaskAtlas::pack(std::vector<Mask>{{2, 3, std::vector<std::uint8_t>(5)}}).failure().code,
            ErrorCode::bad_input);
  const Mask wide{4095, 1, std::vector<std::uint8_t>(4095)};
  EXPECT_EQ(MaskAtlas::pack(std::vector<Mask>{wide}).failure().code, ErrorCode::resource_limit);
  const Mask large{2000, 2000, std::vector<std::uint8_t>(4000000)};
  EXPECT_TRUE(MaskAtlas::pack(std::vector<Mask>(4, large)));
  const auto failed = MaskAtlas::pack(std::vector<Mask>(5, large));
  EXPECT_EQ(failed.failure().message,
            "masks: 5 do not fit into an atlas of 4096 x 4096 texels; use fewer or smaller ones");
}

}  // namespace
}  // namespace brume::smoke
