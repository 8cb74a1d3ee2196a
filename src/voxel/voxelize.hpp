// Triangles into solid voxels.
#pragma once

#include <span>

#include "core/error.hpp"
#include "voxel/bit_grid.hpp"
#include "voxel/int_box.hpp"
#include "voxel/triangle.hpp"

namespace brume::voxel {

/// Succeeds for a layout that a BitGrid can have: every axis in [1, kMaxAxis], a finite voxel size above 0, a
/// finite origin. Otherwise `usage` (resource_limit for an axis above kMaxAxis), in one line.
Result<void> check_frame(const GridLayout& layout);

/// The layout of whole voxels around the box from `low` to `high` [m] with `margin_voxels` (>= 0) more on
/// every side; its origin is a multiple of the voxel size. Fails with bad_input for an empty or infinite box,
/// usage for a bad voxel size or margin, resource_limit when an axis would pass kMaxAxis.
Result<GridLayout> layout_around(glm::vec3 low_world, glm::vec3 high_world, float voxel_size,
                               int margin_voxels);

/// The voxels that a triangle touches. Voxels are closed boxes and triangles closed sets here: touching with
/// a face, an edge or a corner counts, so that a wall exactly between two voxels makes both solid. What lies
/// outside the grid is clipped. Triangles of no area count as the segment or point that they are; one with a
/// corner that is NaN or 2^55 voxels away or more is left out.
///
/// The decision is the separating-axis test of Akenine-Moller 2001 ("Fast 3D Triangle-Box Overlap Testing")
/// over all 13 axes, with the candidates found by projection as in Schwarz & Seidel 2010 ("Fast Parallel
/// Surface and Solid Voxelization on GPUs"). Voxel coordinates (position - origin) / voxel_size are doubles;
/// from there nothing rounds, except that, where the axes are not the box's own, digits below 2^-55 of the
/// triangle's extent do not count.
///
/// Runs on all threads; the bits do not depend on their number. Fails as check_frame does.
Result<BitGrid> voxelize(std::span<const Triangle> triangles, const GridLayout& layout);

/// Makes those voxels of the box solid that voxelize would make solid, and changes no other: what voxelize
/// does, for a part of the grid, on one thread. The box must lie in the grid.
void draw_triangles(std::span<const Triangle> triangles, const IntBox& box, BitGrid& grid);

}  // namespace brume::voxel
