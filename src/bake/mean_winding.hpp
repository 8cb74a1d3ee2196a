// The exact volume of a closed mesh in each voxel of a box.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/box.hpp"
#include "voxel/triangle.hpp"

namespace brume::bake {

/// Per voxel, in the order of grids::DenseGrid.
struct MeanWinding {
  /// The mean of the mesh's winding number over the voxel: the fraction of it that is inside of a solid whose
  /// triangles face outwards, the negative of it where they face inwards, the sum over solids that overlap.
  std::vector<double> values;
  /// 1 where a triangle crosses the interior of the voxel; not set for triangles that only touch it.
  std::vector<std::uint8_t> crossed;
};

/// Cuts the triangles at the planes between voxels. Each piece then adds the volume between it and the top of
/// its voxel, and its projected area to all voxels above it: the signed areas of font rasterizers
/// (R. Levien 2016, "Inside the fastest font renderer in the world"), one dimension up. Exact up to rounding
/// for a closed mesh: an error of about n 2^-52 where n is the largest coordinate in voxels. For an open mesh
/// the values are meaningless. Triangles with a corner that is not finite or more than 1e100 voxels away are
/// dropped. low < high along each axis of the box, and each size is at least 1. On all threads; the same
/// numbers for any number of them.
MeanWinding mean_winding(std::span<const voxel::Triangle> triangles, const Box<double>& box, glm::uvec3 size);

}  // namespace brume::bake
