// Where the smoke of a set of clouds is, and which voxels each boundary corner takes its density from: all
// that stays the same from tick to tick.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "shared/smoke_volume.h"
#include "sim/cell_block.hpp"
#include "sim/world.hpp"
#include "voxel/bit_grid.hpp"
#include "voxel/surface_planes.hpp"

namespace brume::sim {

/// Lists of numbers, one after the other: list i is values[first[i]] to values[first[i + 1]].
struct ListTable {
  std::vector<std::uint32_t> first, values;
  std::span<const std::uint32_t> operator[](std::size_t i) const {
    return std::span(values).subspan(first[i], first[i + 1] - first[i]);
  }
};

/// A smoke voxel that a boundary corner takes from.
struct Contribution {
  std::uint32_t voxel;  ///< Index into SmokeStructure::voxels.
  std::uint32_t weight;
};

/// A corner's density is the sum of weight * density over its contributions, divided by total_weight; voxels
/// that smoke never reaches count in the total. total_weight = 0: no voxel on that side, density 0.
struct CornerSource {
  std::uint32_t first = 0, count = 0;
  std::uint32_t total_weight = 0;
};

class SmokeStructure {
 public:
  SmokeStructure() = default;
  SmokeStructure(const voxel::BitGrid& grid, const PlaneSource& planes, std::span<const LiveCloud> clouds);

  glm::ivec3 window_origin{0}, window_size{0};
  std::vector<std::uint32_t> page_table;
  std::vector<glm::ivec3> bricks;  ///< Of each slot.
  std::vector<std::uint32_t> cells;
  std::vector<shared::BoundaryCell> boundary_cells;
  std::vector<CornerSource> corners;  ///< Eight per corner set.
  std::vector<Contribution> contributions;

  std::vector<glm::ivec3> voxels;  ///< Every voxel that one of the clouds ever fills, once.
  ListTable cloud_voxels;          ///< For each cloud the numbers of its voxels, in the order of its fill.
  ListTable voxel_texels;          ///< For each voxel its texels, counted through all slots.
  ListTable voxel_cells;           ///< For each voxel the boundary cells that take from it.
  glm::ivec3 low{0}, high{-1};     ///< Lowest and highest smoke voxel.

 private:
  class Builder;
};

}  // namespace brume::sim
