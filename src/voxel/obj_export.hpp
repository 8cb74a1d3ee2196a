// Exports the surface of the solid voxels as OBJ, for viewing in any 3D program.
#pragma once

#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <vector>

#include "core/error.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::voxel {

/// A rectangle of voxel faces between solid voxels and free ones, in voxel space.
struct FaceRectangle {
  int axis = 0;           ///< The axis of its normal.
  bool positive = false;  ///< It faces +axis: the solid voxels are below it.
  glm::ivec3 low{0};      ///< Its low corner.
  int width = 1;          ///< Along axis (axis + 1) % 3 [voxels].
  int height = 1;         ///< Along axis (axis + 2) % 3.
};

/// All faces between a solid voxel and one that is free or outside of the grid, each in exactly one
/// rectangle: runs along the width, merged along the height while equal. Sorted by axis, direction, plane.
std::vector<FaceRectangle> surface_rectangles(const BitGrid& grid);

struct ObjCounts {
  std::uint64_t vertices = 0, quads = 0, faces = 0;  ///< faces: of single voxels, before merging.
};

/// Writes the rectangles as quads, counter-clockwise seen from the free side, in world space [m]. The file is
/// written completely or not at all. Fails as AtomicFile does.
Result<ObjCounts> export_obj(const BitGrid& grid, const std::filesystem::path& path);

}  // namespace brume::voxel
