// Fonts: glyphs as pictures, and where they stand in a row. FreeType reads and rasterizes them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace brume::image {

/// DejaVu Sans Bold, where Debian's fonts-dejavu-core puts it.
const std::filesystem::path& default_font();

/// A glyph in the middle of a square, with one empty texel on each side at least.
struct Glyph {
  std::uint32_t side = 0;              ///< Texels; 0: the glyph is blank.
  std::vector<std::uint8_t> coverage;  ///< side * side, rows from the top; 255 within the glyph's outline.
  float centre_x = 0,
        centre_y = 0;   ///< Of the square, from where the pen stands on the base line [cap heights].
  float half_side = 0;  ///< Of the square [cap heights].
};

/// A letter of a row.
struct PlacedLetter {
  char32_t character = 0;
  float pen = 0;  ///< Where its pen stands on the base line [cap heights].
};

class Font {
 public:
  /// Any format of FreeType. `name` is what messages call the bytes. Fails with bad_input when they are no
  /// font with outlines and a Unicode table, or damaged.
  static Result<Font> open(std::vector<std::byte> bytes, const std::string& name);
  /// Reads a file of at most 64 MiB.
  static Result<Font> load(const std::filesystem::path& path);
  Font(Font&&) noexcept;
  Font& operator=(Font&&) noexcept;
  ~Font();

  /// Fails with bad_input where the font has no glyph for the character.
  Result<Glyph> glyph(char32_t character);
  /// The characters of a text (UTF-8, one line) from the pen's start on, kerned, with `spacing` cap heights
  /// more between any two. Fails with bad_input for what is no UTF-8, for control characters, and for a
  /// character that the font lacks.
  Result<std::vector<PlacedLetter>> row(std::string_view text, float spacing);

 private:
  struct Face;
  explicit Font(std::unique_ptr<Face> face);
  std::unique_ptr<Face> face_;
};

}  // namespace brume::image
