// The `.vxl` cache: voxels and surface planes on disk, reused while the scene is unchanged.
//
//   header     magic "BRUMEVXL", version, key, layout, counts, lengths (little-endian, see vxl_file.cpp)
//   payload    zstd: bricks (number, 8 words), cells (key differences, plane counts), planes
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
#include "scene/scene.hpp"
#include "voxel/bit_grid.hpp"
#include "voxel/surface_planes.hpp"
#include "voxel/triangle.hpp"

namespace brume::scenario {

struct VxlContents {
  voxel::BitGrid grid;
  voxel::SurfacePlanes planes;
  std::uint64_t triangles = 0;  ///< Number of triangles the grid was voxelized from.
};

/// The key of a cache: a hash of the triangles in world space, the layout and the format's version.
std::uint64_t vxl_key(std::span<const voxel::Triangle> triangles, const voxel::GridLayout& layout);

/// The bytes of a `.vxl` file. Equal contents give equal bytes.
std::vector<std::byte> encode_vxl(const VxlContents& contents, std::uint64_t key);

/// Reads the output of encode_vxl. Nothing when the bytes are valid but have another key than the expected
/// one; without an expected key any is accepted. Fails with bad_input when they are truncated, damaged,
/// foreign or of another version; the message does not name the file.
Result<std::optional<VxlContents>> decode_vxl(std::span<const std::byte> bytes,
                                              std::optional<std::uint64_t> expected_key);

/// decode_vxl of a file; messages name it.
Result<std::optional<VxlContents>> load_vxl(const std::filesystem::path& path,
                                            std::optional<std::uint64_t> expected_key);

/// Writes the file, completely or not at all. Fails as write_file_atomic does.
Result<void> save_vxl(const std::filesystem::path& path, const VxlContents& contents, std::uint64_t key);

struct Voxels {
  voxel::BitGrid grid;
  voxel::SurfacePlanes planes;
  bool cached = false;      ///< Read from the cache instead of voxelized.
  double milliseconds = 0;  ///< Time of voxelize() only; 0 when cached.
  std::uint64_t triangles = 0;
};

/// The voxels of a scene. Uses the cache at `cache_path` (empty: none) if its key matches this scene and
/// layout; otherwise voxelizes the scene and writes the cache. An invalid cache file causes a warning and is
/// rewritten. Fails as check_frame does, and when the cache cannot be written.
Result<Voxels> load_or_voxelize(const scene::Scene& scene, const voxel::GridLayout& layout,
                                const std::filesystem::path& cache_path);

}  // namespace brume::scenario
