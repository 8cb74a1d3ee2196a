// Fonts: rasterized glyphs and their positions in a row, by FreeType.
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

/// DejaVu Sans Bold: "fonts/DejaVuSans-Bold.ttf" of find_data_file, else the file of Debian's
/// fonts-dejavu-core.
const std::filesystem::path& default_font();

/// A glyph in the middle of a square, with at least one empty texel on each side.
struct Glyph {
  std::uint32_t side = 0;              ///< Texels; 0: the glyph is blank.
  std::vector<std::uint8_t> coverage;  ///< side * side, rows from the top; 255 within the glyph's outline.
  float centre_x = 0,
        centre_y = 0;   ///< Centre of the square relative to the pen on the baseline [cap heights].
  float half_side = 0;  ///< Half the side of the square [cap heights].
};

/// A letter of a row.
struct PlacedLetter {
  char32_t character = 0;
  float pen = 0;  ///< Position of its pen along the baseline [cap heights].
};

class Font {
 public:
  /// Any format of FreeType. `name` names the bytes in messages. Fails with bad_input when they are damaged
  /// or not a font with outlines and a Unicode table.
  static Result<Font> open(std::vector<std::byte> bytes, const std::string& name);
  /// Reads a file of at most 64 MiB.
  static Result<Font> load(const std::filesystem::path& path);
  Font(Font&&) noexcept;
  Font& operator=(Font&&) noexcept;
  ~Font();

  /// Fails with bad_input when the font has no glyph for the character.
  Result<Glyph> glyph(char32_t character);
  /// Lays out the characters of a text (UTF-8, one line) from pen position 0, kerned, with `spacing` cap
  /// heights added between any two. Fails with bad_input for invalid UTF-8, control characters, and
  /// characters missing from the font.
  Result<std::vector<PlacedLetter>> row(std::string_view text, float spacing);

 private:
  struct Face;
  explicit Font(std::unique_ptr<Face> face);
  std::unique_ptr<Face> face_;
};

}  // namespace brume::image
