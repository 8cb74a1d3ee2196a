// The voxels of a scene, cached in a `.vxl` file and reused while scene and layout are unchanged.
#pragma once

#include <cstdint>
#include <filesystem>

#include "core/error.hpp"
#include "scene/scene.hpp"
#include "voxel/level_hash.hpp"
#include "voxel/solids.hpp"
#include "voxel/surface_planes.hpp"

namespace brume::scenario {

struct Voxels {
  voxel::BitGrid grid;
  voxel::SurfacePlanes planes;
  bool cached = false;          ///< Read from the cache instead of voxelized.
  double milliseconds = 0;      ///< Time of voxelize() alone, without planes; 0 when cached.
  std::uint64_t triangles = 0;  ///< Triangles that stop smoke.
  voxel::RoleGrids roles = {};
  voxel::Solids solids() const { return {grid, roles}; }
  /// voxel::level_hash, computed by each call.
  std::uint64_t level_hash() const { return voxel::level_hash(solids(), planes); }
};

/// The voxels of a scene. Uses the cache at `cache_path` (empty: none) if its key matches this scene and
/// layout; otherwise voxelizes the scene and writes the cache. An invalid cache file causes a warning and is
/// rewritten. Fails as check_frame does, and when the cache cannot be written.
Result<Voxels> load_or_voxelize(const scene::Scene& scene, const voxel::GridLayout& layout,
                                const std::filesystem::path& cache_path);

}  // namespace brume::scenario
