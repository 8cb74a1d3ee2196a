#include "palettes/palette.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/similar.hpp"
#include "palettes/text.hpp"

namespace brume::palettes {

// palettes.txt, padded with zeros to whole words (CMakeLists.txt).
extern const std::uint32_t kListWords[];
extern const std::size_t kListBytes;

namespace {

std::string_view list_text() {
  return {reinterpret_cast<const char*>(kListWords), kListBytes};
}

std::optional<Kind> kind_of(std::string_view letter) {
  if (letter == "g") return Kind::gradient;
  if (letter == "q") return Kind::qualitative;
  if (letter == "p") return Kind::unknown;
  return std::nullopt;
}

std::optional<Palette> parse_list_line(std::string_view line) {
  Palette palette;
  palette.name = take_word(line);
  palette.collection = take_word(line);
  const std::optional<Kind> kind = kind_of(take_word(line));
  const std::size_t count = line.size() / 6;
  if (palette.name.empty() || palette.collection.empty() || !kind || line.size() % 6 != 0 ||
      count < kLeastColors || count > kMostColors)
    return std::nullopt;
  palette.kind = *kind;
  palette.colors.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const std::optional<glm::u8vec3> color = color_of_hex(line.substr(6 * i, 6));
    if (!color) return std::nullopt;
    palette.colors.push_back(*color);
  }
  return palette;
}

double hue_distance(double a, double b) {
  return std::abs(std::remainder(a - b, 360.0));
}

bool has_words(const Palette& palette, std::span<const std::string> words) {
  const std::string name = lower(palette.name), collection = lower(palette.collection);
  return std::all_of(words.begin(), words.end(), [&](const std::string& word) {
    return name.find(word) != std::string::npos || collection.find(word) != std::string::npos;
  });
}

}  // namespace

std::string_view name_of(Kind kind) {
  return kind == Kind::gradient ? "gradient" : kind == Kind::qualitative ? "qualitative" : "unknown";
}

Result<std::vector<Palette>> parse_list(std::string_view text) {
  std::vector<Palette> palettes;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::string_view line = take_line(text);
    if (line.empty() || line.front() == '#') continue;
    std::optional<Palette> palette = parse_list_line(line);
    if (!palette)
      return Failure{ErrorCode::internal,
                     "palettes.txt:" + std::to_string(number) +
                         ": expected NAME COLLECTION g|q|p HEX; run script/make-palettes"};
    palettes.push_back(std::move(*palette));
  }
  std::sort(palettes.begin(), palettes.end(),
            [](const Palette& a, const Palette& b) { return a.name < b.name; });
  return palettes;
}

std::span<const Palette> built_in() {
  static const std::vector<Palette> palettes = parse_list(list_text()).value_or_throw();
  return palettes;
}

const Palette* find(std::string_view name) {
  const std::string wanted = lower(name);
  const std::span<const Palette> all = built_in();
  const auto at = [&](std::string_view text) -> const Palette* {
    const auto found = std::lower_bound(all.begin(), all.end(), text,
                                        [](const Palette& p, std::string_view key) { return p.name < key; });
    return found != all.end() && found->name == text ? &*found : nullptr;
  };
  if (const Palette* const found = at(wanted)) return found;
  const std::size_t slash = wanted.find('/');
  if (slash == std::string::npos) return nullptr;
  const Palette* const plain = at(std::string_view(wanted).substr(slash + 1));
  return plain != nullptr && plain->collection == wanted.substr(0, slash) ? plain : nullptr;
}

std::string suggestion_for(std::string_view name) {
  std::vector<std::string> known;
  for (const Palette& palette : built_in()) known.push_back(palette.name);
  return suggestion(name, known, "\"");
}

std::optional<double> main_hue(const Palette& palette) {
  glm::dvec2 sum(0);
  double length = 0;
  for (const glm::u8vec3& color : palette.colors) {
    const glm::dvec3 c = glm::dvec3(color) / 255.0;
    const double high = std::max({c.x, c.y, c.z}), chroma = high - std::min({c.x, c.y, c.z});
    if (chroma <= 0) continue;
    // Travis 1991, "Effective Color Displays": the hue of HSV in sixths of a circle.
    const double sixths = high == c.x   ? (c.y - c.z) / chroma
                          : high == c.y ? 2 + (c.z - c.x) / chroma
                                        : 4 + (c.x - c.y) / chroma;
    const double angle = sixths * std::numbers::pi / 3;
    sum += chroma * glm::dvec2(std::cos(angle), std::sin(angle));
    length += chroma;
  }
  if (length < static_cast<double>(palette.colors.size()) / 16 || glm::length(sum) < 0.5 * length)
    return std::nullopt;
  const double degrees = std::atan2(sum.y, sum.x) * 180 / std::numbers::pi;
  return degrees < 0 ? std::min(degrees + 360, std::nextafter(360.0, 0.0)) : degrees;
}

std::vector<std::uint32_t> search(std::span<const Palette> palettes, const Filter& filter) {
  // Words and number of colours
  std::vector<std::string> words;
  std::string_view rest = filter.words;
  while (!rest.empty()) {
    const std::string_view word = take_word(rest);
    if (!word.empty()) words.push_back(lower(word));
  }
  std::vector<std::pair<double, std::uint32_t>> found;
  for (std::uint32_t i = 0; i < palettes.size(); ++i) {
    const Palette& palette = palettes[i];
    const std::size_t count = palette.colors.size();
    if (count < filter.least_colors || count > filter.most_colors || !has_words(palette, words)) continue;
    // Hue
    double distance = 0;
    if (filter.hue) {
      const std::optional<double> hue = main_hue(palette);
      if (!hue || hue_distance(*hue, *filter.hue) > filter.hue_tolerance) continue;
      distance = hue_distance(*hue, *filter.hue);
    }
    found.emplace_back(distance, i);
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) { return a.first < b.first; });
  std::vector<std::uint32_t> indices;
  for (const auto& [distance, i] : found) indices.push_back(i);
  return indices;
}

}  // namespace brume::palettes
