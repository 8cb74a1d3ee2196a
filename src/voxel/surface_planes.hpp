// Where the surfaces run between the voxels, so that smoke can end at the wall and not at the grid.
//
// A *cell* is the cube between eight neighbouring voxel centres: cell c spans [c + 0.5, c + 1.5) in voxel
// space and its corners are the voxels c .. c + 1. This is the domain of one trilinear interpolation. Where
// at least one corner is solid, up to three planes say on which sides of which surfaces a point of the cell
// lies.
#pragma once

#include <glm/glm.hpp>
#include <span>

namespace brume::voxel {

constexpr int kMaxPlanes = 3;

/// A plane through a cell. A point is on its positive side when
/// dot(normal, position_voxel - cell_centre) > offset, with cell_centre = cell + 1.
struct Plane {
  glm::vec3 normal{0};  ///< Unit length, voxel space.
  float offset = 0;     ///< [voxels], within [-1, 1].
};

}  // namespace brume::voxel
