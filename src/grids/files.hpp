// Reads and writes files of volume grids by their suffix: .brv, .vdb, .nvdb.
//
// A .brv file is read and written here (docs/brv-format.md). OpenVDB and NanoVDB run only in the program
// brume-vdb, a child process with limits that speaks .brv over a pipe: their readers crash on damaged files.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/error.hpp"
#include "grids/grid.hpp"

namespace brume::grids {

/// Beyond these a file is refused (resource_limit) before anything of that size is allocated.
struct GridLimits {
  std::uint64_t bytes = 1ull << 33;          ///< Of memory_of() all grids.
  std::uint64_t active_voxels = 1ull << 33;  ///< Of a grid, tiles included.
  double seconds = 600;                      ///< Processor time of the child process.
};

/// Whether a file holds volume grids, by its suffix in any case.
bool is_grid_file(const std::filesystem::path& path);

/// Reads all grids of a file; skips those of types that ValueType lacks, with a warning. Fails with bad_input
/// for a missing, damaged or foreign file, resource_limit beyond the limits, and no_device when brume-vdb is
/// not installed beside the program.
Result<GridFile> load_grid_file(const std::filesystem::path& path, const GridLimits& limits = {});

/// Writes all grids, completely or not at all. Fails as write_file_atomic does, and with bad_input for a grid
/// that the format cannot hold.
Result<void> save_grid_file(const std::filesystem::path& path, const GridFile& file);

}  // namespace brume::grids
