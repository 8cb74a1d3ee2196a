#include "core/utf8.hpp"
#include "palettes/palette.hpp"

#include <charconv>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "apps/cli/command.hpp"
#include "apps/cli/info.hpp"
#include "apps/cli/palette_sheet.hpp"
#include "apps/command_line/console.hpp"
#include "apps/command_line/json.hpp"
#include "core/platform/console.hpp"
#include "image/png.hpp"
#include "palettes/file.hpp"
#include "palettes/sample.hpp"

namespace brume::cli {
namespace {

constexpr int kSwatchCells = 24;

struct PaletteOptions {
  std::vector<std::string> words;
  std::string colors, sheet, json;
  std::optional<double> hue;
  std::uint32_t limit = 0;
};

/// "5" or "3-12".
void read_counts(const std::string& text, palettes::Filter& filter) {
  const char* const end = text.data() + text.size();
  std::size_t low = 0, high = 0;
  auto [next, error] = std::from_chars(text.data(), end, low);
  high = low;
  if (error == std::errc() && next != end && *next == '-') {
    const auto second = std::from_chars(next + 1, end, high);
    next = second.ptr;
    error = second.ec;
  }
  if (error != std::errc() || next != end || low > high || high > palettes::kMostColors)
    throw Error(ErrorCode::usage, "--colors '" + text + "': expected LEAST-MOST up to " +
                                      std::to_string(palettes::kMostColors) +
                                      ", such as 3-12, or one number");
  filter.least_colors = low;
  filter.most_colors = high;
}

/// no-color.org, and terminals without escape sequences.
bool has_colors() {
  const char* const none = std::getenv("NO_COLOR");
  return (none == nullptr || *none == '\0') && platform::shows_escape_sequences(platform::kOutput);
}

std::string make_swatch(const palettes::Palette& palette) {
  const palettes::Space space =
      palette.kind == palettes::Kind::qualitative ? palettes::Space::nearest : palettes::Space::oklab;
  std::string text;
  for (int i = 0; i < kSwatchCells; ++i) {
    const glm::u8vec3 c = palettes::sample_byte(palette, (i + 0.5) / kSwatchCells, space);
    char cell[40];
    std::snprintf(cell, sizeof cell, "\x1b[48;2;%d;%d;%dm ", int{c.x}, int{c.y}, int{c.z});
    text += cell;
  }
  return text + "\x1b[0m  ";
}

std::string line_of(const palettes::Palette& palette, bool colored) {
  char text[96];
  const std::string name = printable(palette.name);
  std::snprintf(text, sizeof text, "%-36s %5zu  ", name.c_str(), palette.colors.size());
  std::string line = text + printable(palette.collection);
  line.erase(line.find_last_not_of(' ') + 1);
  return (colored ? make_swatch(palette) : "") + line + "\n";
}

Json to_json(const palettes::Palette& palette) {
  Json colors = Json::list({});
  for (const glm::u8vec3& c : palette.colors) {
    char text[8];
    std::snprintf(text, sizeof text, "#%02x%02x%02x", unsigned{c.x}, unsigned{c.y}, unsigned{c.z});
    colors.push_back(text);
  }
  const std::optional<double> hue = palettes::main_hue(palette);
  return {{"name", palette.name},
          {"collection", palette.collection},
          {"kind", std::string(palettes::name_of(palette.kind))},
          {"hue", hue ? Json(*hue) : Json(nullptr)},
          {"colors", colors}};
}

/// The files among the words; without any, what the program holds.
std::vector<palettes::Palette> files_of(std::vector<std::string>& words, Outputs& outputs) {
  std::vector<palettes::Palette> files;
  std::vector<std::string> rest;
  for (const std::string& word : words) {
    if (!palettes::is_palette_file(word)) {
      rest.push_back(word);
      continue;
    }
    outputs.reads(to_path(word));
    files.push_back(palettes::load_palette(to_path(word)).value_or_throw());
  }
  words = rest;
  return files;
}

void list_palettes(const PaletteOptions& options, Outputs& outputs) {
  // Outputs
  if (!options.sheet.empty()) expect_suffix("-o", options.sheet, {".png"});
  outputs.writes("-o", to_path(options.sheet), FileKind::png);
  outputs.writes("--json", to_path(options.json), FileKind::json);
  palettes::Filter filter;
  if (!options.colors.empty()) read_counts(options.colors, filter);
  filter.hue = options.hue;

  // Search
  std::vector<std::string> words = options.words;
  const std::vector<palettes::Palette> files = files_of(words, outputs);
  const std::span<const palettes::Palette> all = files.empty() ? palettes::built_in() : files;
  for (const std::string& word : words) filter.words += word + " ";
  std::vector<std::uint32_t> found = palettes::search(all, filter);
  const std::size_t count = found.size();
  if (options.limit > 0) found.resize(std::min<std::size_t>(count, options.limit));
  if (count == 0)
    throw Error(ErrorCode::usage, "none of " + std::to_string(all.size()) +
                                      " palettes matches; give fewer or other words, without any for a list");

  // Results
  if (!options.sheet.empty())
    image::save_png(to_path(options.sheet), palette_sheet(all, found).value_or_throw()).value_or_throw();
  if (!options.json.empty()) {
    Json list = Json::list({});
    for (const std::uint32_t i : found) list.push_back(to_json(all[i]));
    write_json(options.json, {{"found", count}, {"palettes", list}});
  }
  if (options.json == "-") return;
  const bool colored = has_colors();
  for (const std::uint32_t i : found) print(line_of(all[i], colored));
}

}  // namespace

Command add_palettes(CommandLine& program) {
  Command command =
      declare(program, "palettes", "Lists and searches the named palettes that --palette takes.",
              "  brume palettes sea\n"
              "  brume palettes crameri --colors 3-64 --limit 10\n"
              "  brume palettes --hue 210 --limit 40 -o blue.png");
  auto options = std::make_shared<PaletteOptions>();
  const Arguments& arguments = command.arguments;
  // Which palettes to list.
  arguments
      .add_option("WORDS", options->words,
                  "Only those with these words in the name or the collection; a .gpl or .json file is "
                  "listed in place of the named ones")
      .type_name("");
  arguments.add_option("--colors", options->colors, "Only those with so many colours").type_name("A-B");
  arguments
      .add_option(
          "--hue", options->hue,
          "Only those whose main hue is within 20 degrees of this, the nearest first: 0 red, 120 green, "
          "240 blue")
      .range(0.0, 360.0)
      .type_name("DEGREES");
  // How to show them.
  arguments.add_option("--limit", options->limit, "List so many at most; default 0: all").type_name("N");
  arguments.add_option("-o,--output", options->sheet, "Write a picture of them (.png)").type_name("FILE");
  declare_json(arguments, options->json, "the list");
  command.run = [options, common = command.common] { list_palettes(*options, common->outputs); };
  return command;
}

}  // namespace brume::cli
