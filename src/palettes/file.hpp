// Palettes of the user: GIMP's .gpl and JSON.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "core/error.hpp"
#include "palettes/palette.hpp"

namespace brume::palettes {

/// Longest file [bytes].
constexpr std::uint64_t kMostFileBytes = std::uint64_t{1} << 20;

/// Whether a file is one of a palette, by its suffix .gpl or .json in any case.
bool is_palette_file(std::string_view path);

/// Reads a file by its suffix. The name is that in the file, else the file's without its suffix. Fails with
/// one line that begins with "FILE:LINE: ": bad_input for a file of another form or with fewer than
/// kLeastColors colours, resource_limit for more than kMostColors or kMostFileBytes.
Result<Palette> load_palette(const std::filesystem::path& path);

/// A palette of GIMP: the line "GIMP Palette", lines "Name: NAME" and "Columns: N", then "R G B NAME" for
/// each colour, numbers from 0 to 255; lines that are empty or begin with # do not count. `file` is the
/// file's name in messages.
Result<Palette> parse_gpl(std::string_view text, const std::string& file);

/// A list of colours, ["#rrggbb", ...], or an object {"name": NAME, "kind": "gradient" | "qualitative",
/// "colors": LIST}, of which only "colors" is required.
Result<Palette> parse_json(std::string_view text, const std::string& file);

}  // namespace brume::palettes
