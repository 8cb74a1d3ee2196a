#include "apps/cli/palette_sheet.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <string_view>

#include "image/font.hpp"
#include "palettes/sample.hpp"

namespace brume::cli {
namespace {

// Texels.
constexpr std::uint32_t kStripWidth = 236, kStripHeight = 20, kCellWidth = 248, kCellHeight = 40,
                        kMargin = 12;
constexpr std::uint32_t kLeastColumns = 4, kMostHeight = 16000;
constexpr float kCapHeight = 8, kBaseline = 32;
constexpr std::uint8_t kPaper = 255;
constexpr int kSubsamples = 4;  // per axis and texel of a letter

/// Letters of one size on white paper.
class Lettering {
 public:
  explicit Lettering(image::Font font) : font_(std::move(font)) {}

  /// Writes a text from a pen position on, as far as `end`.
  Result<void> write(image::Image8& image, std::string_view text, glm::vec2 pen_px, float end_px) {
    const auto row = font_.row(text, 0);
    if (!row) return row.failure();
    for (const image::PlacedLetter& letter : *row) {
      const auto known = glyphs_.find(letter.character);
      if (known == glyphs_.end()) {
        auto glyph = font_.glyph(letter.character);
        if (!glyph) return glyph.failure();
        glyphs_.emplace(letter.character, std::move(*glyph));
      }
      draw(image, glyphs_.at(letter.character), pen_px + glm::vec2(kCapHeight * letter.pen, 0), end_px);
    }
    return {};
  }

 private:
  static void draw(image::Image8& image, const image::Glyph& glyph, glm::vec2 pen, float end) {
    if (glyph.side == 0) return;
    const glm::vec2 middle = pen + kCapHeight * glm::vec2(glyph.centre_x, -glyph.centre_y);
    const float half = kCapHeight * glyph.half_side;
    const glm::ivec2 low(glm::floor(middle - half)), high(glm::ceil(middle + half));
    if (static_cast<float>(high.x) > end) return;
    for (int y = std::max(low.y, 0); y < std::min(high.y, static_cast<int>(image.height)); ++y)
      for (int x = std::max(low.x, 0); x < std::min(high.x, static_cast<int>(image.width)); ++x) {
        const std::uint32_t ink =
            coverage(glyph, (glm::vec2(x, y) - middle + half) / (2 * half), 1 / (2 * half));
        std::uint8_t* const texel =
            &image.rgba[4 * (static_cast<std::size_t>(y) * image.width + static_cast<std::size_t>(x))];
        for (int c = 0; c < 3; ++c) texel[c] = static_cast<std::uint8_t>(texel[c] * (255 - ink) / 255);
      }
  }

  /// Mean over a texel at `low`, as wide as `size`, both in parts of the glyph's square.
  static std::uint32_t coverage(const image::Glyph& glyph, glm::vec2 low, float size) {
    std::uint32_t sum = 0;
    for (int j = 0; j < kSubsamples; ++j)
      for (int i = 0; i < kSubsamples; ++i) {
        const glm::vec2 at = low + size * (glm::vec2(i, j) + 0.5f) / float(kSubsamples);
        if (at.x < 0 || at.y < 0 || at.x >= 1 || at.y >= 1) continue;
        const glm::uvec2 texel(at * static_cast<float>(glyph.side));
        sum += glyph.coverage[std::size_t{texel.y} * glyph.side + texel.x];
      }
    return sum / (kSubsamples * kSubsamples);
  }

  image::Font font_;
  std::map<char32_t, image::Glyph> glyphs_;
};

void draw_strip(image::Image8& image, const palettes::Palette& palette, glm::uvec2 low) {
  const palettes::Space space =
      palette.kind == palettes::Kind::qualitative ? palettes::Space::nearest : palettes::Space::oklab;
  for (std::uint32_t x = 0; x < kStripWidth; ++x) {
    const glm::u8vec3 color = palettes::sample_byte(palette, (x + 0.5) / kStripWidth, space);
    for (std::uint32_t y = 0; y < kStripHeight; ++y) {
      std::uint8_t* const texel = &image.rgba[4 * (std::size_t{low.y + y} * image.width + low.x + x)];
      for (int c = 0; c < 3; ++c) texel[c] = color[c];
    }
  }
}

}  // namespace

Result<image::Image8> palette_sheet(std::span<const palettes::Palette> palettes,
                                    std::span<const std::uint32_t> indices) {
  auto font = image::Font::load(image::default_font());
  if (!font) return font.failure();
  Lettering lettering(std::move(*font));
  // As many columns as the height requires.
  const auto count = static_cast<std::uint32_t>(indices.size());
  const std::uint32_t most_rows = kMostHeight / kCellHeight;
  const std::uint32_t columns =
      std::min(std::max(count, 1u), std::max(kLeastColumns, (count + most_rows - 1) / most_rows));
  const std::uint32_t rows = std::max((count + columns - 1) / columns, 1u);
  image::Image8 image;
  image.width = columns * kCellWidth + kMargin;
  image.height = rows * kCellHeight + kMargin;
  image.rgba.assign(std::size_t{4} * image.width * image.height, kPaper);
  // Columns from the top
  for (std::uint32_t i = 0; i < count; ++i) {
    const palettes::Palette& palette = palettes[indices[i]];
    const glm::uvec2 low(kMargin + i / rows * kCellWidth, kMargin + i % rows * kCellHeight);
    draw_strip(image, palette, low);
    const std::string label = palette.name + "  " + std::to_string(palette.colors.size());
    const glm::vec2 pen = glm::vec2(low) + glm::vec2(0, kBaseline);
    const auto written = lettering.write(image, label, pen, pen.x + kStripWidth);
    if (!written) return written.failure();
  }
  return image;
}

}  // namespace brume::cli
