// Reads volume files that need no decoder of images: .brv here (docs/reference/formats.md), .vdb and .nvdb
// in the program brume-vdb (worker.hpp).
#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "grids/grid.hpp"
#include "grids/limits.hpp"

namespace brume::grids {

/// Reads a file of grids: load_volume_file, or load_grid_file (files.hpp), which reads more kinds of them.
using GridReader = Result<GridFile> (*)(const std::filesystem::path& path, const GridLimits& limits,
                                        const GridChoice& choice);

/// Whether load_volume_file reads a file, by its suffix in any case.
bool is_volume_file(const std::filesystem::path& path);

/// The grids of `choice` of a file that was read as a whole, in their order; all without a choice. Fails as
/// `choice` does.
Result<GridFile> chosen_of(Result<GridFile> file, const GridChoice& choice);

/// Reads all grids of a .brv, .vdb or .nvdb file, or the grids of `choice`. Fails as load_grid_file.
Result<GridFile> load_volume_file(const std::filesystem::path& path, const GridLimits& limits = {},
                                  const GridChoice& choice = {});

}  // namespace brume::grids
