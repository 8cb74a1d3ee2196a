// Dense arrays for other programs: a .raw file of 32-bit floats, and a .json file that describes it
// (docs/guides/volumes.md).
#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "grids/grid.hpp"
#include "grids/limits.hpp"

namespace brume::grids {

/// The array file of a description: "smoke.raw" of "smoke.json".
std::filesystem::path raw_path_of(const std::filesystem::path& json);

/// Whether a file is a description, by its suffix in any case.
bool is_raw_description(const std::filesystem::path& path);

/// Reads a description and the array that it names, which lies in the same folder. Voxels that differ from
/// the background are active. Fails with bad_input for missing or damaged files, resource_limit beyond the
/// limits.
Result<GridFile> load_raw(const std::filesystem::path& json, const GridLimits& limits = {});

/// The array file that a description names. Fails with bad_input.
Result<std::filesystem::path> read_raw_path(const std::filesystem::path& json);

/// Writes the box around the active voxels, first the array, then its description. Fails with bad_input for a
/// grid of another type than float32 or without active voxels, and as write_file_atomic.
Result<void> save_raw(const std::filesystem::path& json, const Grid& grid, const GridLimits& limits = {});

}  // namespace brume::grids
