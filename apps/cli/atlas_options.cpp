#include "apps/cli/atlas_options.hpp"

#include <algorithm>
#include <array>
#include <charconv>

#include "apps/cli/command.hpp"
#include "apps/command_line/parse.hpp"
#include "core/file.hpp"
#include "core/utf8.hpp"
#include "scene/files/load.hpp"

namespace brume::cli {
namespace {

using grids::AtlasDepth;

/// What the importer of an engine expects of a volume whose y is up, in metres, right-handed
/// (docs/guides/volume-textures.md).
struct Preset {
  const char* name;
  const char* axes;
};
constexpr std::array kPresets{Preset{"unreal", "+x +z +y"}, Preset{"unity", "-x -y +z"},
                              Preset{"godot", "+x +y +z"}, Preset{"houdini", "+x -y +z"}};

std::vector<std::string> preset_names() {
  std::vector<std::string> names;
  for (const Preset& preset : kPresets) names.emplace_back(preset.name);
  return names;
}

AtlasDepth depth_of(const AtlasOptions& options) {
  const std::string suffix = scene::lower_extension(to_path(options.output));
  if (suffix == ".png") {
    const std::uint32_t bits = options.bits.value_or(8);
    if (bits == 32) throw Error(ErrorCode::usage, "--bits 32: a PNG stores 8 or 16; name an .exr file");
    return bits == 8 ? AtlasDepth::unorm8 : AtlasDepth::unorm16;
  }
  const std::uint32_t bits = options.bits.value_or(16);
  if (bits == 8) throw Error(ErrorCode::usage, "--bits 8: OpenEXR stores 16 or 32; name a .png file");
  return bits == 16 ? AtlasDepth::half : AtlasDepth::float32;
}

std::uint32_t columns_of(const AtlasOptions& options, const grids::SliceLayout& layout) {
  const bool has_preset = !options.preset.empty();
  const std::string& text = options.layout;
  if (text == "square" || (text.empty() && has_preset)) return near_square_columns(layout, has_preset);
  if (text == "strip") return layout.tiles();
  if (text.empty()) {
    // A strip as long as any GPU can sample.
    constexpr std::uint64_t kLongestStrip = 16384;
    grids::SliceLayout strip = layout;
    strip.columns = layout.tiles();
    const std::uint64_t width = std::uint64_t{strip.tiles()} * (strip.tile().x + 2 * strip.padding);
    return width <= kLongestStrip ? strip.columns : near_square_columns(layout, false);
  }
  std::uint32_t columns = 0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), columns);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size() || columns == 0)
    throw Error(ErrorCode::usage,
                "--layout '" + text + "': expected strip, square or a number of tiles in a row, such as 8");
  return columns;
}

std::optional<grids::AtlasRange> parse_atlas_range(const std::string& text) {
  if (text.empty()) return std::nullopt;
  const auto numbers = parse_numbers(text, 2);
  if (!numbers || !((*numbers)[0] < (*numbers)[1]))
    throw Error(ErrorCode::usage,
                "--range '" + text + "': expected the lowest and the highest value, such as 0,2");
  return grids::AtlasRange{static_cast<float>((*numbers)[0]), static_cast<float>((*numbers)[1])};
}

/// Settings that Godot's importer reads beside an image. Others are its own defaults.
std::string godot_import_text(const AtlasTarget& target, const std::filesystem::path& image) {
  const bool is_exr = target.depth == AtlasDepth::half || target.depth == AtlasDepth::float32;
  return "[remap]\n\nimporter=\"texture_3d\"\ntype=\"Texture3D\"\n\n[deps]\n\nsource_file=\"res://" +
         image.filename().string() + "\"\n\n[params]\n\ncompress/mode=" + (is_exr ? "2" : "0") +
         "\ncompress/no_bptc_if_rgb=false\nflags/repeat=0\nflags/filter=true\nflags/mipmaps=false\n"
         "flags/srgb=0\nslices/horizontal=" +
         std::to_string(target.layout.columns) + "\nslices/vertical=" + std::to_string(target.layout.rows()) +
         "\n";
}

}  // namespace

void declare_atlas_options(const Arguments& arguments, AtlasOptions& options) {
  arguments
      .add_option("-o,--output", options.output,
                  "Image to write (.png, .exr); its description is written beside it (.json)")
      .required()
      .type_name("FILE");
  // How tiles lie in the image.
  arguments
      .add_option("--layout", options.layout,
                  "Tiles: in a strip, near a square, or so many in a row; default: a strip if it is at most "
                  "16384 texels long, square with --preset")
      .type_name("strip|square|N");
  arguments.add_option("--padding", options.padding, "Texels around each tile that mirror it; default 0")
      .range(0u, 64u)
      .type_name("N");
  arguments.add_flag("--mips", options.mips,
                     "Also write smaller levels, as FILE_mip1 and so on, until tiles cannot be halved");
  // What a texel holds.
  arguments
      .add_option("--bits", options.bits,
                  "Bits of a channel: 8 or 16 in PNG, 16 or 32 in OpenEXR; default: 8, 16")
      .type_name("N");
  arguments
      .add_option("--range", options.range,
                  "Values that become 0 and 1 in a PNG; default: 0,1, or all values where they exceed it")
      .type_name("LOW,HIGH");
  // Which way the volume lies in it.
  arguments
      .add_option("--axes", options.axes,
                  "Directions of columns (right), rows (down) and tiles in the volume, such as \"+x -y +z\"")
      .type_name("AXES");
  arguments
      .add_option("--preset", options.preset,
                  "Axes and layout as the importer of unreal, unity, godot or houdini expects them")
      .one_of(preset_names())
      .type_name("ENGINE");
}

grids::AtlasAxes axes_of(const AtlasOptions& options, const grids::AtlasAxes& axes) {
  if (!options.axes.empty() && !options.preset.empty())
    throw Error(ErrorCode::usage, "--axes: --preset " + options.preset + " sets them; give one of the two");
  if (!options.axes.empty()) {
    const auto parsed = grids::parse_axes(options.axes);
    if (!parsed)
      throw Error(
          ErrorCode::usage,
          "--axes '" + options.axes + "': expected x, y and z, each once with a sign, such as \"+x -y +z\"");
    return *parsed;
  }
  for (const Preset& preset : kPresets)
    if (options.preset == preset.name) return *grids::parse_axes(preset.axes);
  return axes;
}

void check_atlas_options(const AtlasOptions& options) {
  expect_suffix("-o", options.output, {".png", ".exr"});
  if (options.bits && *options.bits != 8 && *options.bits != 16 && *options.bits != 32)
    throw Error(ErrorCode::usage, "--bits " + std::to_string(*options.bits) + ": expected 8, 16 or 32");
  depth_of(options);
  parse_atlas_range(options.range);
  axes_of(options, grids::kUprightAxes);
}

AtlasTarget atlas_target(const AtlasOptions& options, glm::uvec3 size, const grids::AtlasAxes& axes,
                         Outputs& outputs) {
  check_atlas_options(options);
  AtlasTarget target;
  target.json = to_path(options.output).replace_extension(".json");
  target.depth = depth_of(options);
  if (const auto range = parse_atlas_range(options.range)) target.ranges = {*range};
  target.layout = {size, axes_of(options, axes), 1, options.padding};
  target.layout.columns = columns_of(options, target.layout);
  if (const auto fault = grids::fault_of(target.layout))
    throw Error(ErrorCode::resource_limit, options.output + ": " + *fault);
  if (options.mips) target.levels = grids::level_count(target.layout);

  const bool is_png = scene::lower_extension(to_path(options.output)) == ".png";
  for (std::uint32_t level = 0; level < target.levels; ++level)
    outputs.writes(level == 0 ? "-o" : "--mips", grids::atlas_image_path(target.json, target.depth, level),
                   is_png ? FileKind::png : FileKind::exr);
  outputs.writes("-o", target.json, FileKind::slice_atlas);
  if (options.preset == "godot") {
    target.godot_import = grids::atlas_image_path(target.json, target.depth, 0);
    target.godot_import += ".import";
    outputs.writes("--preset", target.godot_import, FileKind::godot_import);
  }
  return target;
}

void save_atlas(const AtlasTarget& target, std::vector<grids::DenseGrid> channels,
                const glm::dmat4& world_from_box) {
  grids::SliceAtlas atlas{target.layout, target.depth, world_from_box, std::move(channels), {}};
  for (std::size_t i = 0; i < atlas.channels.size(); ++i)
    atlas.ranges.push_back(target.ranges.empty() ? grids::range_of(atlas.channels[i])
                                                 : target.ranges[std::min(i, target.ranges.size() - 1)]);
  grids::save_slice_atlas(target.json, atlas, target.levels).value_or_throw();
  if (target.godot_import.empty()) return;
  const std::filesystem::path image = grids::atlas_image_path(target.json, target.depth, 0);
  write_file_atomic(target.godot_import, godot_import_text(target, image)).value_or_throw();
}

std::string to_text(const grids::SliceLayout& layout) {
  const glm::uvec2 image = layout.image_size(), tile = layout.tile();
  const auto size = [](glm::uvec2 s) { return std::to_string(s.x) + "x" + std::to_string(s.y); };
  return size(image) + " texels: " + std::to_string(layout.tiles()) + " tiles of " + size(tile);
}

Json to_json(const AtlasTarget& target) {
  const grids::SliceLayout& layout = target.layout;
  const glm::uvec2 image = layout.image_size(), tile = layout.tile();
  return {{"output", target.json.string()},
          {"depth", grids::name_of(target.depth)},
          {"image_size", Json::list({image.x, image.y})},
          {"tile", Json::list({tile.x, tile.y})},
          {"tiles", layout.tiles()},
          {"columns", layout.columns},
          {"levels", target.levels}};
}

}  // namespace brume::cli
