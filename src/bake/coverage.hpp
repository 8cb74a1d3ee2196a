// How much of each voxel of a box is inside of a closed mesh.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <span>
#include <string>

#include "core/box.hpp"
#include "grids/dense_grid.hpp"
#include "voxel/triangle.hpp"

namespace brume::bake {

/// Where a mesh is not the closed surface of a solid, facing outwards.
struct MeshFaults {
  std::size_t open_edges =
      0;                    ///< Edges that the triangles beside them do not use as often in each direction.
  bool inside_out = false;  ///< The mesh as a whole faces inwards; corrected.
  /// "has 12 open edges, so ..." for a warning after the mesh's name; empty: a closed mesh.
  std::string text() const;
};

struct Coverage {
  grids::DenseGrid grid;  ///< The fraction of each voxel's volume that is inside, [0, 1]; without a name.
  MeshFaults faults;
};

/// Triangles meet where they have corners at the same position. Triangles with a corner that is not finite do
/// not count, nor does one with two corners at the same position.
MeshFaults find_faults(std::span<const voxel::Triangle> triangles);

/// The exact solid volume in each voxel, up to rounding (mean_winding.hpp), if the mesh is closed.
///
/// Inside is where the winding number is not 0. So a part that faces inwards is a cavity where it lies in a
/// solid, and a solid where it does not: its orientation is corrected. Parts of a mesh may overlap: what is
/// inside of several counts once where it fills a voxel, and may count too high where it does not.
///
/// The inside of a mesh that is not closed is where its generalized winding number (winding_number.hpp) is
/// nearer to 1 or -1 than to 0. Of the voxels that a triangle crosses, or that are near such a border, the
/// fraction of 4 x 4 x 4 points counts; the others are empty or full, as their middle. A sheet encloses
/// nothing. Takes about 50 times as long.
///
/// low < high along each axis of the box, and each size is at least 1. On all threads; the same bytes for any
/// number of them and any order of the triangles.
Coverage mesh_coverage(std::span<const voxel::Triangle> triangles, const Box<double>& box, glm::uvec3 size);

}  // namespace brume::bake
