// The options of `brume render --flipbook`, and the files that they ask for.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/command_line/arguments.hpp"
#include "apps/command_line/outputs.hpp"
#include "image/flipbook.hpp"

namespace brume::cli {

/// As given; empty: by default.
struct FlipbookOptions {
  std::string grid, maps, alpha, preset;
  std::optional<std::uint32_t> gutter;
};
void declare_flipbook(const Arguments& arguments, FlipbookOptions& options);

/// What the options say, checked.
struct FlipbookPlan {
  image::FlipbookLayout layout;
  std::filesystem::path output;  ///< File of the colours; the others are named after it.
  bool is_straight = true;       ///< Whether colours are not multiplied by alpha.
  bool has_six_way = false, has_normals = false, has_emission = false, has_motion = false;
  bool normals_up = true, motion_up = false;  ///< Whether green is the direction up.
};
/// Whether frames are drawn under light from each side, too.
bool is_lit_by_sides(const FlipbookPlan& plan);
/// `tile_px`: with the gutter. Throws Error (usage).
FlipbookPlan parse_flipbook(const FlipbookOptions& options, glm::uvec2 tile_px,
                            const std::filesystem::path& output);
/// A map beside the colours, such as "_motion": its file.
std::filesystem::path map_file(const FlipbookPlan& plan, const std::string& map);
std::filesystem::path description_file(const FlipbookPlan& plan);
/// The maps beside the colours.
std::vector<std::string> map_names(const FlipbookPlan& plan);
bool is_exr(const FlipbookPlan& plan);
void declare_flipbook_files(const FlipbookPlan& plan, Outputs& outputs);

}  // namespace brume::cli
