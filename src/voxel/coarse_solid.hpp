// A grid at a lower resolution: cells of several voxels that are solid or free.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/box.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::voxel {

/// Cells per axis of a grid whose cells have an edge of `edge` voxels, the last ones perhaps beyond its end.
inline glm::ivec3 coarse_size(glm::ivec3 voxels, int edge) {
  return (voxels + (edge - 1)) / edge;
}

/// Voxels per edge of a cell: the smallest number for which there are at most `most_cells`, and at most
/// `most_per_axis` of them along each axis.
int coarse_edge(glm::ivec3 voxels, std::uint32_t most_cells, int most_per_axis);

/// Which of the cells in a box are solid, x fastest: those whose solid voxels amount to at least half of a
/// wall of one voxel across the cell. The box lies within coarse_size.
std::vector<bool> coarse_solid(const BitGrid& grid, int edge, const Box<int>& cells);

}  // namespace brume::voxel
