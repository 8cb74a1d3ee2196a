#include "scenario/voxel_cache.hpp"

#include <chrono>
#include <optional>
#include <span>
#include <vector>

#include "core/hash.hpp"
#include "core/log.hpp"
#include "scenario/world_triangles.hpp"
#include "voxel/voxelize.hpp"
#include "vxl/file.hpp"

namespace brume::scenario {
namespace {

using voxel::GridLayout;
using voxel::SurfacePlanes;
using voxel::Triangle;

// A hash of all that the voxels depend on: the triangles in world space, the layout and the format's version.
std::uint64_t cache_key(const voxel::TrianglesByRole& triangles, const GridLayout& layout) {
  static_assert(sizeof(Triangle) == 36 && sizeof(GridLayout) == 28, "no padding to hash");
  std::uint64_t key = hash_values(std::span(&vxl::kVersion, 1));
  key = hash_bytes(std::as_bytes(std::span(&layout, 1)), key);
  key = hash_bytes(std::as_bytes(std::span(triangles.smoke)), key);
  if (!triangles.walls && triangles.grilles.empty()) return key;
  for (const auto& list : {triangles.walls.value_or(triangles.smoke), triangles.grilles})
    key = hash_bytes(std::as_bytes(std::span(list)), key + list.size());
  return key;
}

double milliseconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

// The cache's contents, if it exists, is valid and has this key.
std::optional<vxl::Contents> from_cache(const std::filesystem::path& path, std::uint64_t key) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return std::nullopt;
  auto loaded = vxl::load(path, key);
  if (!loaded) {
    log_warning(loaded.failure().message + "; voxelizing again");
    return std::nullopt;
  }
  if (!*loaded) log_info(path.string() + ": made from another scene or grid; voxelizing again");
  return std::move(*loaded);
}

}  // namespace

Result<Voxels> load_or_voxelize(const scene::Scene& scene, const GridLayout& layout,
                                const std::filesystem::path& cache_path) {
  if (auto checked = voxel::check_frame(layout); !checked) return checked.failure();
  const voxel::TrianglesByRole triangles = triangles_by_role(scene);
  const std::uint64_t key = cache_key(triangles, layout);
  if (!cache_path.empty()) {
    if (auto contents = from_cache(cache_path, key))
      return Voxels{std::move(contents->grid), std::move(contents->planes), true, 0,
                    contents->triangles,       std::move(contents->roles)};
  }

  // Voxels of what stops smoke, its surfaces, and what has other roles.
  const auto start = std::chrono::steady_clock::now();
  auto grid = voxel::voxelize(triangles.smoke, layout);
  const double milliseconds = milliseconds_since(start);
  if (!grid) return grid.failure();
  vxl::Contents contents{std::move(*grid), {}, triangles.smoke.size()};
  contents.planes = SurfacePlanes::build(triangles.smoke, contents.grid);
  auto roles = voxel::voxelize_roles(triangles, contents.grid);
  if (!roles) return roles.failure();
  contents.roles = std::move(*roles);
  if (!cache_path.empty()) {
    if (auto saved = vxl::save(cache_path, contents, key); !saved) return saved.failure();
  }
  return Voxels{std::move(contents.grid), std::move(contents.planes), false, milliseconds,
                contents.triangles,       std::move(contents.roles)};
}

}  // namespace brume::scenario
