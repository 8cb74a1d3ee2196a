#include "palettes/file.hpp"

#include "core/file.hpp"
#include "core/utf8.hpp"
#include "palettes/text.hpp"

namespace brume::palettes {
namespace {

constexpr std::string_view kGplHead = "GIMP Palette";
constexpr std::size_t kLongestName = 256;

Failure gpl_fault(const std::string& file, std::size_t line, const std::string& what) {
  return {ErrorCode::bad_input, file + ":" + std::to_string(line) + ": " + what};
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
  while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
  return text;
}

/// Removes a number from 0 to 255 and the blanks before it.
std::optional<std::uint8_t> take_byte(std::string_view& text) {
  text = trimmed(text);
  unsigned value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const auto taken = static_cast<std::size_t>(end - text.data());
  if (error != std::errc() || value > 255) return std::nullopt;
  text.remove_prefix(taken);
  if (!text.empty() && text.front() != ' ' && text.front() != '\t') return std::nullopt;
  return static_cast<std::uint8_t>(value);
}

std::optional<glm::u8vec3> gpl_color(std::string_view line) {
  const auto red = take_byte(line);
  const auto green = red ? take_byte(line) : std::nullopt;
  const auto blue = green ? take_byte(line) : std::nullopt;
  if (!blue) return std::nullopt;
  return glm::u8vec3(*red, *green, *blue);
}

}  // namespace

bool is_palette_file(std::string_view path) {
  const std::string name = lower(path);
  return name.ends_with(".gpl") || name.ends_with(".json");
}

Result<Palette> load_palette(const std::filesystem::path& path) {
  const std::string file = path.string();
  if (!is_palette_file(file))
    return Failure{ErrorCode::usage, file + ": unknown file suffix; expected .gpl or .json"};
  const Result<std::string> text = read_text_file(path, kMostFileBytes);
  if (!text) return text.failure();
  Result<Palette> palette = lower(file).ends_with(".gpl") ? parse_gpl(*text, file) : parse_json(*text, file);
  if (palette && palette->name.empty()) palette->name = path.stem().string();
  return palette;
}

Result<Palette> parse_gpl(std::string_view text, const std::string& file) {
  // Head
  text = without_byte_order_mark(text);
  std::size_t number = 1;
  if (trimmed(take_line(text)) != kGplHead)
    return gpl_fault(file, number, "expected \"GIMP Palette\", the first line of a .gpl file");
  Palette palette;
  // Settings and colours
  while (!text.empty()) {
    const std::string_view line = trimmed(take_line(text));
    ++number;
    if (line.empty() || line.front() == '#' || line.starts_with("Columns:")) continue;
    if (line.starts_with("Name:")) {
      palette.name = trimmed(line.substr(5));
      if (palette.name.size() > kLongestName || !is_utf8(palette.name))
        return gpl_fault(file, number, "expected a name of at most 256 bytes in UTF-8");
      continue;
    }
    const std::optional<glm::u8vec3> color = gpl_color(line);
    if (!color) return gpl_fault(file, number, "expected a colour as R G B NAME, each from 0 to 255");
    if (palette.colors.size() == kMostColors)
      return Failure{ErrorCode::resource_limit,
                     file + ":" + std::to_string(number) + ": more than 4096 colours; remove some"};
    palette.colors.push_back(*color);
  }
  if (palette.colors.size() < kLeastColors)
    return gpl_fault(file, number,
                     "expected at least two colours, found " + std::to_string(palette.colors.size()));
  return palette;
}

}  // namespace brume::palettes
