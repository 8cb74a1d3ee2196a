// What --palette takes: a palette and the part of it that is used.
#pragma once

#include <string>
#include <string_view>

#include "core/error.hpp"
#include "palettes/palette.hpp"

namespace brume::palettes {

struct PaletteChoice {
  Palette palette;
  /// Positions of the first and the last colour that is used, each in [0, 1]. low > high: the palette is
  /// read backwards; equal: one colour.
  double low = 0, high = 1;
};

/// "NAME", "NAME:0.2-0.6" or "NAME:0.6-0.2", where NAME is a palette's (find) or a file's that ends in .gpl
/// or .json (load_palette). Fails with usage for unknown names and ranges outside of [0, 1], and as
/// load_palette does.
Result<PaletteChoice> parse_palette_choice(std::string_view text);

/// The file that such a text names, without the range behind it; empty for a palette of the program.
std::string_view file_of_choice(std::string_view text);

/// The same choice as a text: with at most three digits behind the point, without a range that is all.
std::string choice_text(std::string_view name, double low, double high);

}  // namespace brume::palettes
