// Exact voxelization of triangles.
#pragma once

#include <span>

#include "core/box.hpp"
#include "core/error.hpp"
#include "voxel/bit_grid.hpp"
#include "voxel/triangle.hpp"

namespace brume::voxel {

/// Succeeds for a layout that a BitGrid accepts: every axis in [1, kMaxAxis], a finite voxel size above 0, a
/// finite origin. Otherwise fails with usage (resource_limit for an axis above kMaxAxis), in one line.
Result<void> check_frame(const GridLayout& layout);

/// The smallest layout around the box from `low` to `high` [m] with a margin of `margin_voxels` (>= 0) on
/// every side; its origin is a multiple of the voxel size. Fails with bad_input for an empty or infinite box,
/// usage for an invalid voxel size or margin, resource_limit when an axis would exceed kMaxAxis.
Result<GridLayout> layout_around(glm::vec3 low_world, glm::vec3 high_world, float voxel_size,
                                 int margin_voxels);

/// Makes every voxel that a triangle touches solid. Voxels and triangles are closed sets: touching a face, an
/// edge or a corner counts, so a wall exactly between two voxels makes both solid. Triangles are clipped to
/// the grid. Degenerate triangles count as segments or points; one with a corner that is NaN or at least 2^55
/// voxels away is ignored.
///
/// The decision is the separating-axis test of Akenine-Moller 2001 ("Fast 3D Triangle-Box Overlap Testing")
/// over all 13 axes, with the candidates found by projection as in Schwarz & Seidel 2010 ("Fast Parallel
/// Surface and Solid Voxelization on GPUs"). Voxel coordinates (position - origin) / voxel_size are doubles;
/// all further arithmetic is exact, except that the axes other than the box's own ignore digits below 2^-55
/// of the triangle's extent.
///
/// Runs on all threads; the result does not depend on their number. Fails as check_frame does.
Result<BitGrid> voxelize(std::span<const Triangle> triangles, const GridLayout& layout);

/// Voxelizes into a part of an existing grid, on one thread: makes solid what voxelize would make solid
/// within the box and changes no other voxel. The box must lie in the grid.
void draw_triangles(std::span<const Triangle> triangles, const Box<int>& box, BitGrid& grid);

}  // namespace brume::voxel
