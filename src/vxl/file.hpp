// The `.vxl` file: voxels and surface planes on disk, with a key that identifies what they were built from.
//
//   header     magic "BRUMEVXL", version, key, layout, counts, lengths (little-endian, see file.cpp)
//   roles      version 2: counts of two more lists of bricks, voxels of glass and of grilles
//   payload    zstd: bricks (number, 8 words), cells (key differences, plane counts), planes; the lists of
//              roles
//   checksum   XXH3-64 of all bytes before it
//
// Files are untrusted: lengths and counts are checked in 64 bits against the grid and the file before
// anything is allocated, then bricks, cells and planes one by one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "voxel/bit_grid.hpp"
#include "voxel/solids.hpp"
#include "voxel/surface_planes.hpp"

namespace brume::vxl {

struct Contents {
  voxel::BitGrid grid;
  voxel::SurfacePlanes planes;
  std::uint64_t triangles = 0;  ///< Number of triangles the grid was voxelized from.
  voxel::RoleGrids roles = {};
};

/// The version of files without roles, and of those with roles. Files of any other version are rejected.
constexpr std::uint32_t kVersion = 1, kRolesVersion = 2;

/// The bytes of a `.vxl` file, with a key of the caller's choice. Equal contents and keys give equal bytes.
std::vector<std::byte> encode(const Contents& contents, std::uint64_t key);

/// Reads the output of encode. Nothing when the bytes are valid but have another key than the expected
/// one; without an expected key any is accepted. Fails with bad_input when they are truncated, damaged,
/// foreign or of another version; the message does not name the file.
Result<std::optional<Contents>> decode(std::span<const std::byte> bytes,
                                       std::optional<std::uint64_t> expected_key);

/// Reads a file; messages name it.
Result<std::optional<Contents>> load(const std::filesystem::path& path,
                                     std::optional<std::uint64_t> expected_key);

/// Writes the file, completely or not at all. Fails as write_file_atomic does.
Result<void> save(const std::filesystem::path& path, const Contents& contents, std::uint64_t key);

}  // namespace brume::vxl
