// The options of commands that write slice atlases.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "apps/cli/units.hpp"
#include "apps/command_line/arguments.hpp"
#include "apps/command_line/json.hpp"
#include "apps/command_line/outputs.hpp"
#include "grids/files/slice_atlas.hpp"

namespace brume::cli {

/// As given; empty: by default.
struct AtlasOptions {
  std::string output, layout, axes, preset, range;
  std::optional<std::uint32_t> bits;
  std::uint32_t padding = 0;
  bool mips = false;
};

/// Lies beside every image.
inline const FileBeside kAtlasDescription{".json", FileKind::slice_atlas};

/// Declares -o and the options of the image.
void declare_atlas_options(const Arguments& arguments, AtlasOptions& options);

/// Throws Error (usage) for options that are wrong whatever is baked.
void check_atlas_options(const AtlasOptions& options);

/// The directions of --axes or --preset, or these.
grids::AtlasAxes axes_of(const AtlasOptions& options, const grids::AtlasAxes& axes);

/// What is written.
struct AtlasTarget {
  std::filesystem::path json;
  grids::AtlasDepth depth = grids::AtlasDepth::unorm8;
  grids::SliceLayout layout;
  std::vector<grids::AtlasRange>
      ranges;  ///< Range of each channel, or one for all; empty: they fit the values.
  std::uint32_t levels = 1;
  std::filesystem::path godot_import;  ///< Empty: none.
};

/// The target of a volume of this size; declares its files. Throws Error.
AtlasTarget atlas_target(const AtlasOptions& options, glm::uvec3 size, const grids::AtlasAxes& axes,
                         Outputs& outputs);

/// Writes the images, the description, and what the preset adds. Throws Error.
void save_atlas(const AtlasTarget& target, std::vector<grids::DenseGrid> channels,
                const glm::dmat4& world_from_box = glm::dmat4(1));

/// "2048x64 texels: 32 tiles of 64x64".
std::string to_text(const grids::SliceLayout& layout);
/// The same for --json.
Json to_json(const AtlasTarget& target);

}  // namespace brume::cli
