// Reads and writes files of volume grids by their suffix: .brv, .vdb, .nvdb, and .json, which describes an
// array of numbers or a slice atlas. Reads tanks of spheres (.spheres), too (tank_grids.hpp).
//
// OpenVDB and NanoVDB run only in the program brume-vdb, a child process with limits that speaks .brv over a
// pipe: their readers crash on damaged files.
#pragma once

#include <filesystem>
#include <vector>

#include "core/error.hpp"
#include "grids/grid.hpp"
#include "grids/limits.hpp"

namespace brume::grids {

/// Whether a file holds volume grids, by its suffix in any case. Also an image (.png, .exr) beside whose name
/// lies the description of a slice atlas.
bool is_grid_file(const std::filesystem::path& path);

/// All files that load_grid_file reads for one: itself, and what it describes or is described by. Fails with
/// bad_input for a description that cannot be read.
Result<std::vector<std::filesystem::path>> files_of(const std::filesystem::path& path);

/// Reads all grids of a file; skips grids of types that ValueType lacks, with a warning. Fails with bad_input
/// for a missing, damaged or foreign file, resource_limit beyond the limits, and no_device when brume-vdb is
/// not installed beside the program.
/// With `choice`, other grids of a .brv file are not read, and not in the result; fails as `choice`.
Result<GridFile> load_grid_file(const std::filesystem::path& path, const GridLimits& limits = {},
                                const GridChoice& choice = {});

/// Writes all grids to a .brv, .vdb or .nvdb file, completely or not at all. Fails as write_file_atomic does,
/// and with bad_input for a grid that the format cannot hold.
Result<void> save_grid_file(const std::filesystem::path& path, const GridFile& file);

}  // namespace brume::grids
