#include "apps/cli/flipbook_options.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "apps/command_line/targets.hpp"
#include "core/error.hpp"
#include "core/utf8.hpp"

namespace brume::cli {
namespace {

/// Which way green points in the maps of an engine (docs/guides/volume-textures.md).
struct FlipbookPreset {
  const char* name;
  bool normals_up, motion_up;
};
constexpr std::array kFlipbookPresets{FlipbookPreset{"unity", true, true},
                                      FlipbookPreset{"unreal", false, false},
                                      FlipbookPreset{"godot", true, false}};

glm::uvec2 parse_tiles(const std::string& text) {
  glm::uvec2 grid(0);
  int read = 0;
  const bool is_plain = text.find_first_not_of("0123456789x") == std::string::npos;
  if (!is_plain || std::sscanf(text.c_str(), "%5ux%5u%n", &grid.x, &grid.y, &read) != 2 ||
      static_cast<std::size_t>(read) != text.size() || grid.x == 0 || grid.y == 0)
    throw Error(ErrorCode::usage, "--flipbook '" + text + "': expected columns and rows, such as 8x8");
  return grid;
}

void parse_maps(const std::string& text, FlipbookPlan& plan) {
  std::string rest = text.empty() ? "" : text + ",";
  for (std::size_t end = 0; (end = rest.find(',')) != std::string::npos; rest.erase(0, end + 1)) {
    const std::string map = rest.substr(0, end);
    if (map == "six-way")
      plan.has_six_way = true;
    else if (map == "normals")
      plan.has_normals = true;
    else if (map == "emission")
      plan.has_emission = true;
    else if (map == "motion")
      plan.has_motion = true;
    else
      throw Error(ErrorCode::usage,
                  "--flipbook-maps '" + text +
                      "': expected six-way, normals, emission and motion, with commas between");
  }
}

}  // namespace

bool is_exr(const FlipbookPlan& plan) {
  return target_file_kind(plan.output) == FileKind::exr;
}
std::filesystem::path map_file(const FlipbookPlan& plan, const std::string& map) {
  std::filesystem::path file = plan.output;
  file.replace_extension();
  file += to_path(map + plan.output.extension().string());
  return file;
}
std::filesystem::path description_file(const FlipbookPlan& plan) {
  return std::filesystem::path(plan.output).replace_extension(".json");
}

/// The maps beside the colours, by their part of the file's name.
std::vector<std::string> map_names(const FlipbookPlan& plan) {
  std::vector<std::string> names;
  if (plan.has_six_way) names.insert(names.end(), {"_right_top_back", "_left_bottom_front"});
  if (plan.has_normals) names.emplace_back("_normals");
  if (plan.has_emission) names.emplace_back("_emission");
  if (plan.has_motion) names.emplace_back("_motion");
  return names;
}

bool is_lit_by_sides(const FlipbookPlan& plan) {
  return plan.has_six_way || plan.has_normals;
}

void declare_flipbook(const Arguments& arguments, FlipbookOptions& options) {
  arguments
      .add_option("--flipbook", options.grid,
                  "Write the frames as tiles of one image for sprites, with transparency: columns and rows; "
                  "--size is "
                  "that of a tile (default 256x256)")
      .type_name("CxR");
  arguments
      // The sheets.
      .add_option(
          "--flipbook-maps", options.maps,
          "Sheets beside the colours: six-way (light from six sides, two images), normals, emission, motion")
      .type_name("MAP,..");
  arguments
      .add_option("--flipbook-alpha", options.alpha,
                  "Whether colours are multiplied by alpha; default: straight, premultiplied for .exr")
      .one_of({"straight", "premultiplied"})
      .type_name("FORM");
  // The tiles.
  arguments
      .add_option("--flipbook-gutter", options.gutter,
                  "Empty texels along each side of a tile, within its size; default 2")
      .range(0u, 64u)
      .type_name("N");
  arguments
      .add_option("--flipbook-preset", options.preset,
                  "Directions of green in normals and motion as unity, unreal or godot expects them")
      .one_of({"unity", "unreal", "godot"})
      .type_name("ENGINE");
}

FlipbookPlan parse_flipbook(const FlipbookOptions& options, glm::uvec2 tile_px,
                            const std::filesystem::path& output) {
  FlipbookPlan plan;
  plan.output = plain_name(output);
  if (target_kind(output) != TargetKind::picture)
    throw Error(
        ErrorCode::usage,
        "-o " + output.string() + ": a flipbook is one image, .png or .exr; remove --flipbook for frames");
  // The layout: tiles must be larger than their gutters, and the sheet an image.
  const glm::uvec2 grid = parse_tiles(options.grid);
  plan.layout = {grid.x, grid.y, tile_px, options.gutter.value_or(2)};
  if (2 * plan.layout.gutter >= std::min(tile_px.x, tile_px.y))
    throw Error(ErrorCode::usage, "--flipbook-gutter " + std::to_string(plan.layout.gutter) +
                                      ": leaves nothing of tiles of " + std::to_string(tile_px.x) + "x" +
                                      std::to_string(tile_px.y) + "; give a larger --size");
  const std::uint64_t width = std::uint64_t{grid.x} * tile_px.x, height = std::uint64_t{grid.y} * tile_px.y;
  if (std::max(width, height) > image::kMaxAxis)
    throw Error(ErrorCode::usage, "--flipbook " + options.grid + ": the sheet has " + std::to_string(width) +
                                      "x" + std::to_string(height) + " texels, at most " +
                                      std::to_string(image::kMaxAxis) +
                                      " along each side are possible; give a "
                                      "smaller --size");
  // The maps, and which way their green points.
  parse_maps(options.maps, plan);
  plan.is_straight = options.alpha.empty() ? !is_exr(plan) : options.alpha == "straight";
  for (const FlipbookPreset& preset : kFlipbookPresets) {
    if (options.preset != preset.name) continue;
    plan.normals_up = preset.normals_up;
    plan.motion_up = preset.motion_up;
  }
  return plan;
}

void declare_flipbook_files(const FlipbookPlan& plan, Outputs& outputs) {
  const FileKind kind = target_file_kind(plan.output);
  outputs.writes("-o", plan.output, kind);
  outputs.writes("-o", description_file(plan), FileKind::flipbook);
  for (const std::string& name : map_names(plan))
    outputs.writes("--flipbook-maps", map_file(plan, name), kind);
}

}  // namespace brume::cli
