#include "palettes/choice.hpp"

#include <charconv>
#include <cstdio>

#include "core/utf8.hpp"
#include "palettes/file.hpp"

namespace brume::palettes {
namespace {

/// A name in a message, which may be any text.
std::string shown(std::string_view name) {
  return shortened(name, 40);
}

/// Removes a number in [0, 1], digits with or without a point.
std::optional<double> take_position(std::string_view& text) {
  double value = 0;
  const auto [end, error] =
      std::from_chars(text.data(), text.data() + text.size(), value, std::chars_format::fixed);
  if (error != std::errc() || text.front() == '-' || !(value >= 0 && value <= 1)) return std::nullopt;
  text.remove_prefix(static_cast<std::size_t>(end - text.data()));
  return value;
}

bool read_range(std::string_view text, PaletteChoice& choice) {
  const auto low = take_position(text);
  if (!low || !text.starts_with('-')) return false;
  text.remove_prefix(1);
  const auto high = take_position(text);
  if (!high || !text.empty()) return false;
  choice.low = *low;
  choice.high = *high;
  return true;
}

std::string without_zeros(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f", value);
  std::string result = text;
  while (result.ends_with('0')) result.pop_back();
  if (result.ends_with('.')) result.pop_back();
  return result;
}

}  // namespace

Result<PaletteChoice> parse_palette_choice(std::string_view text) {
  // Range
  PaletteChoice choice;
  const std::size_t colon = text.rfind(':');
  std::string_view name = text;
  if (colon != std::string_view::npos && !is_palette_file(text)) {
    name = text.substr(0, colon);
    if (!read_range(text.substr(colon + 1), choice))
      return Failure{ErrorCode::usage, "palette " + shown(text) +
                                           ": expected a range in [0, 1] behind the colon, such as " +
                                           shown(name) + ":0.2-0.6"};
  }
  // Palette
  if (is_palette_file(name)) {
    Result<Palette> file = load_palette(to_path(name));
    if (!file) return file.failure();
    choice.palette = std::move(*file);
    return choice;
  }
  const Palette* const found = find(name);
  if (found == nullptr)
    return Failure{ErrorCode::usage, "palette \"" + shown(name) + "\": unknown" + suggestion_for(name) +
                                         "; brume palettes lists all, files end in .gpl or .json"};
  choice.palette = *found;
  return choice;
}

std::string_view file_of_choice(std::string_view text) {
  const std::string_view name = is_palette_file(text) ? text : text.substr(0, text.rfind(':'));
  return is_palette_file(name) ? name : std::string_view();
}

std::string choice_text(std::string_view name, double low, double high) {
  const std::string first = without_zeros(low), last = without_zeros(high);
  if (first == "0" && last == "1") return std::string(name);
  return std::string(name) + ":" + first + "-" + last;
}

}  // namespace brume::palettes
