// Where a grid is, in the voxels of another one.
#pragma once

#include <optional>

#include "grids/grid.hpp"

namespace brume::grids {

/// A grid of booleans with the transform `world_from_index`, true at least wherever filtering finds `grid`
/// above 0: in boxes around the voxels of each of its bricks. Nothing where that takes more than 2^18 bricks,
/// or for a transform without an inverse.
std::optional<Grid> make_coverage(const Grid& grid, const glm::dmat4& world_from_index);

}  // namespace brume::grids
