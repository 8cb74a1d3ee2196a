#include "image/font.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "core/file.hpp"

namespace brume::image {
namespace {

Font default_face() {
  return Font::load(default_font()).value_or_throw();
}

/// Bounds of the texels that a glyph covers by half or more: left, right, top and bottom, in cap heights from
/// the pen.
struct Ink {
  float left = 1e9f, right = -1e9f, bottom = 1e9f, top = -1e9f;
  double fraction = 0;  ///< Covered fraction of the square.
};

Ink ink_of(const Glyph& g) {
  Ink ink;
  const float texel = 2 * g.half_side / static_cast<float>(g.side);
  for (std::uint32_t y = 0; y < g.side; ++y)
    for (std::uint32_t x = 0; x < g.side; ++x) {
      if (g.coverage[y * g.side + x] < 128) continue;
      const float left = g.centre_x - g.half_side + static_cast<float>(x) * texel;
      const float top = g.centre_y + g.half_side - static_cast<float>(y) * texel;
      ink.left = std::min(ink.left, left);
      ink.right = std::max(ink.right, left + texel);
      ink.top = std::max(ink.top, top);
      ink.bottom = std::min(ink.bottom, top - texel);
      ink.fraction += 1.0 / (g.side * g.side);
    }
  return ink;
}

TEST(Font, MeasuresInCapitalHeights) {
  Font font = default_face();
  constexpr float kTexel =
      1.5f / 69;  // 96 to an em, a capital letter 0.73 em; half a texel per side, and rounding
  for (const char32_t letter : {U'H', U'I', U'E', U'M'}) {
    const Ink ink = ink_of(font.glyph(letter).value_or_throw());
    EXPECT_NEAR(ink.top, 1, kTexel);
    EXPECT_NEAR(ink.bottom, 0, kTexel);
    EXPECT_GT(ink.left, 0);
  }
  const Ink small = ink_of(font.glyph(U'x').value_or_throw()),
            deep = ink_of(font.glyph(U'p').value_or_throw());
  EXPECT_LT(small.top, 0.8f);
  EXPECT_LT(deep.bottom, -0.2f);
  // A bar is as wide as it is inked.
  const Glyph bar = font.glyph(U'I').value_or_throw();
  const Ink ink = ink_of(bar);
  EXPECT_NEAR(ink.fraction,
              (ink.right - ink.left) * (ink.top - ink.bottom) / (4 * bar.half_side * bar.half_side), 1e-3);
}

TEST(Font, CentresEachGlyphInASquareWithAnEmptyRim) {
  Font font = default_face();
  for (char32_t letter = U'!'; letter <= U'~'; ++letter) {
    const Glyph g = font.glyph(letter).value_or_throw();
    ASSERT_GE(g.side, 3u);
    ASSERT_EQ(g.coverage.size(), g.side * g.side);
    for (std::uint32_t i = 0; i < g.side; ++i)
      for (const std::uint32_t at : {i, i * g.side, (g.side - 1) * g.side + i, i * g.side + g.side - 1})
        EXPECT_EQ(g.coverage[at], 0);
    const Ink ink = ink_of(g);
    const float texel = 2 * g.half_side / static_cast<float>(g.side);
    EXPECT_NEAR(ink.left + ink.right, 2 * g.centre_x, 3 * texel);
    EXPECT_NEAR(ink.top + ink.bottom, 2 * g.centre_y, 3 * texel);
  }
  EXPECT_EQ(font.glyph(U' ').value_or_throw().side, 0u);
}

TEST(Font, RowsAreKernedAndSpaced) {
  Font font = default_face();
  const auto last_pen = [&](const char* text, float spacing) {
    return font.row(text, spacing).value_or_throw().back().pen;
  };
  // Nothing stands between H and H but their advance, and a row of n has n - 1 of them.
  const float advance = last_pen("HH", 0);
  EXPECT_GT(advance, 1);
  EXPECT_LT(advance, 1.4f);
  EXPECT_NEAR(last_pen("HHHHH", 0), 4 * advance, 1e-4f);
  EXPECT_NEAR(last_pen("HHHHH", 0.25f), 4 * (advance + 0.25f), 1e-4f);
  // A and V are kerned.
  EXPECT_LT(last_pen("AVA", 0), last_pen("AH", 0) + last_pen("VH", 0) - 0.1f);
  EXPECT_TRUE(font.row("", 0).value_or_throw().empty());
}

TEST(Font, ReadsUtf8) {
  Font font = default_face();
  const auto row = font.row("a\xc3\xa9\xe2\x82\xac\xf0\x9f\x98\x80", 0).value_or_throw();
  ASSERT_EQ(row.size(), 4u);
  EXPECT_EQ(row[1].character, U'\u00e9');
  EXPECT_EQ(row[2].character, U'\u20ac');
  EXPECT_EQ(row[3].character, U'\U0001f600');
  for (const char* bad :
       {"\x80", "a\xc3", "\xc0\x80", "\xed\xa0\x80", "\xf4\x90\x80\x80", "\xff", "\xe2\x28\xa1"})
    EXPECT_EQ(font.row(bad, 0).failure().message, "the text is not valid UTF-8") << bad;
  EXPECT_EQ(font.row("a\nb", 0).failure().message,
            "the text has the control character U+000A; expected one line of letters");
}

TEST(Font, NamesAMissingGlyph) {
  Font font = default_face();
  const std::string message = font.row("\xe6\xbc\xa2", 0).failure().message;  // a Han character
  EXPECT_EQ(message, default_font().string() +
                         ": the font has no glyph for U+6F22; choose another font or another character");
  EXPECT_EQ(font.glyph(U'\u6f22').failure().message, message);
}

TEST(Font, RejectsOtherFiles) {
  for (const std::size_t size : {0u, 1u, 100u}) {
    const auto font = Font::open(std::vector<std::byte>(size, std::byte{0x41}), "x.ttf");
    ASSERT_FALSE(font);
    EXPECT_EQ(font.failure().code, ErrorCode::bad_input);
    EXPECT_EQ(font.failure().message.rfind("x.ttf: ", 0), 0u);
  }
  EXPECT_FALSE(Font::load("/no/such/font.ttf"));
}

TEST(Font, SurvivesDamage) {
  const std::vector<std::byte> whole = read_file(default_font()).value_or_throw();
  std::mt19937 random(1);
  for (int i = 0; i < 60; ++i) {
    std::vector<std::byte> bytes = whole;
    if (i % 2 == 0) bytes.resize(random() % bytes.size());
    for (int k = 0; k < 40 && !bytes.empty(); ++k)
      bytes[(i % 4 < 2 ? random() % 2000 : random()) % bytes.size()] = static_cast<std::byte>(random());
    auto font = Font::open(std::move(bytes), "damaged.ttf");
    if (!font) continue;
    static_cast<void>(font->row("BRUME", 0));
    for (const char32_t letter : {U'B', U'R', U'U', U'M', U'E'}) {
      const auto g = font->glyph(letter);
      EXPECT_TRUE(!g || g->coverage.size() == std::size_t{g->side} * g->side);
    }
  }
}

}  // namespace
}  // namespace brume::image
