// Named palettes: a list that the program holds, and searches in it.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"

namespace brume::palettes {

/// Most and least colours of a palette.
constexpr std::size_t kMostColors = 4096, kLeastColors = 2;

/// What a palette is meant for.
enum class Kind {
  gradient,     ///< Its colours are equally spaced points of a curve.
  qualitative,  ///< Its colours are apart from each other; what is between them means nothing.
  unknown,
};

struct Palette {
  std::string name;        ///< Lower case without blanks; "COLLECTION/NAME" where several have that name.
  std::string collection;  ///< A row of the table in docs/guides/spheres.md; empty: a file of the user.
  Kind kind = Kind::unknown;
  std::vector<glm::u8vec3> colors;  ///< sRGB, kLeastColors to kMostColors.
};

/// "gradient", "qualitative", "unknown".
std::string_view name_of(Kind kind);

/// The palettes of data/palettes/palettes.txt, in the order of their names. Read when first called, in about
/// two milliseconds; from any thread.
std::span<const Palette> built_in();

/// The palette of a name in any case, or of "COLLECTION/NAME" for one whose name is plain; nullptr: none.
const Palette* find(std::string_view name);

/// What to add to a message about a name that is none: core/similar.hpp.
std::string suggestion_for(std::string_view name);

/// What a search looks for; all conditions hold for what it finds.
struct Filter {
  std::string words;  ///< Each occurs in the name or the collection, in any case; blanks are between them.
  std::size_t least_colors = 0, most_colors = kMostColors;
  std::optional<double> hue;  ///< Near the main hue [degrees]; any finite number, modulo 360.
  double hue_tolerance = 20;  ///< [degrees], [0, 180].
  bool operator==(const Filter&) const = default;
};

/// Indices of the palettes that a filter lets through: in their order, or with `hue` the nearest hue first.
std::vector<std::uint32_t> search(std::span<const Palette> palettes, const Filter& filter);

/// The hue of HSV (0 red, 120 green, 240 blue) that a palette as a whole has [degrees, [0, 360)]: the
/// direction of the sum of its colours' hues as vectors as long as their chroma (the largest less the
/// smallest channel). Nothing where that sum is shorter than half the sum of the lengths (rainbows), or
/// where the mean chroma is below 1/16 (greys).
std::optional<double> main_hue(const Palette& palette);

/// Parses lines of palettes.txt: "NAME COLLECTION KIND HEX", where KIND is g, q or p and HEX six digits for
/// each colour; lines that begin with # are comments. For the text of the build and its tests: fails with
/// internal, and the line, where one is not of this form.
Result<std::vector<Palette>> parse_list(std::string_view text);

}  // namespace brume::palettes
