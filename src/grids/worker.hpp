// The child process brume-vdb (apps/vdb): the parent's side. Internal to this folder; files.hpp is the
// interface.
//
// The child has limits of memory, processor time and files. Whatever it does, this process goes on: all of
// its bytes pass the reader of .brv files.
#pragma once

#include <filesystem>
#include <span>

#include "core/error.hpp"
#include "grids/grid.hpp"
#include "grids/limits.hpp"

namespace brume::grids {

/// Reads a .vdb or .nvdb file. Warns of grids that it skips. Fails with bad_input when the file is missing or
/// damaged, or crashed its reader; resource_limit beyond the limits; no_device without brume-vdb, which is
/// searched where the environment variable BRUME_VDB names it, beside this program, and on the PATH.
Result<GridFile> read_in_child(const std::filesystem::path& path, const GridLimits& limits);

/// Writes a .vdb or .nvdb file, completely or not at all. Fails as AtomicFile does, with bad_input for a grid
/// that the format cannot hold, and with no_device.
Result<void> write_in_child(const std::filesystem::path& path, const GridFile& file);

}  // namespace brume::grids
