// The foreign formats of brume-vdb, each behind functions in our types. They throw Error, std::bad_alloc, and
// whatever the libraries throw; a damaged file may crash them, which is why they run in this program.
#pragma once

#include <functional>
#include <span>
#include <string>

#include "core/error.hpp"
#include "grids/grid.hpp"
#include "grids/limits.hpp"

namespace brume::vdb {

/// What is read of a file, grid after grid, so that only one is in memory.
struct Reader {
  std::function<void(const grids::Grid&)> add;
  std::function<void(const std::string&)> warn;  ///< Names the grids that are skipped.
};

/// Throws Error (resource_limit) unless a grid fits into the limits, before its voxels are copied. `used` are
/// the bytes of the grids before it; adds its own.
void check_limits(const std::string& name, std::uint64_t active, std::uint64_t bytes, std::uint64_t& used,
                  const grids::GridLimits& limits);

/// Reads a .vdb file. Returns the file's metadata.
std::vector<grids::Metadata> read_vdb(const std::string& path, const grids::GridLimits& limits,
                                      const Reader& reader);
/// Writes a .vdb file over the open file `output`.
void write_vdb(const grids::GridFile& file, int output);

/// Reads a .nvdb file. Returns the file's metadata, if it is one of ours.
std::vector<grids::Metadata> read_nvdb(const std::string& path, const grids::GridLimits& limits,
                                       const Reader& reader);
/// Writes a .nvdb file to a descriptor. Throws Error (bad_input) for a grid of a type that NanoVDB lacks.
void write_nvdb(const grids::GridFile& file, int output);

/// Writes all bytes to a descriptor. Fails with resource_limit.
Result<void> write_all(int output, std::span<const std::byte> bytes);

}  // namespace brume::vdb
