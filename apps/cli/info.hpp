// What `brume info` reports of the larger kinds of files.
#pragma once

#include <filesystem>

#include "apps/cli/summary.hpp"
#include "apps/command_line/outputs.hpp"

namespace brume::cli {

/// A scene file: counts, size, lights, and what `render` shows of it without a timeline: camera, grid and a
/// place for smoke; with `lists_objects` a line with the name of each object. Throws Error.
Summary scene_summary(const std::filesystem::path& path, bool lists_objects, Outputs& outputs);

/// A timeline: its events and, if its files exist, grid, doors and what happens to each smoke; otherwise a
/// warning or, with `check`, an Error (bad_input).
Summary timeline_summary(const std::filesystem::path& path, bool check, Outputs& outputs);

/// The grids of a volume file. Throws Error.
Summary volume_summary(const std::filesystem::path& path, Outputs& outputs);

}  // namespace brume::cli
