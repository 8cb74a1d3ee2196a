// Geodesic flood fill: which voxels smoke reaches first.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "sim/block_set.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::sim {

/// Length of a move to a face, edge or corner neighbour. The chamfer weights (10, 14, 17) keep a fill round:
/// Borgefors 1986, "Distance Transformations in Digital Images", scaled to the unit voxel = 10.
constexpr std::uint32_t kFaceStep = 10, kEdgeStep = 14, kCornerStep = 17;

/// Largest budget of one fill; the distances of so many voxels fit 32 bits.
constexpr std::uint32_t kMaxFillVoxels = 1u << 27;

struct FilledVoxel {
  glm::ivec3 voxel;
  std::uint32_t distance;  ///< Geodesic chamfer distance from the source, 10 units a voxel.
  bool operator==(const FilledVoxel&) const = default;
};

/// A fill as a set.
struct Flood {
  BlockSet voxels;
  std::vector<std::uint32_t> distances;  ///< As in FilledVoxel, by rank in `voxels`.
  /// A distance that occurs, and the number of voxels at that distance or nearer.
  struct Count {
    std::uint32_t distance;
    std::uint64_t count;
  };
  std::vector<Count> counts;  ///< Nearest first.
};

/// Returns the `budget` nearest free voxels to `source` by geodesic chamfer distance, sorted by (distance,
/// voxel index), index = x + size.x * (y + size.y * z); ties at the budget go to the lowest index. Fewer when
/// the space reachable from `source` is smaller; none when `source` is solid or outside the grid.
///
/// A move goes to one of 26 neighbours and requires *every* voxel of the box it spans (2, 4 or 8) to be free:
/// the fill crosses no wall and leaks through no diagonal crack. Time and memory are proportional to the
/// voxels filled.
///
/// budget: at most kMaxFillVoxels.
std::vector<FilledVoxel> flood_fill(const voxel::BitGrid& grid, glm::ivec3 source, std::uint32_t budget);

/// The same with the voxels of `domain` as the only free ones, without a budget: all that `source` can reach.
/// Applied to the result of a flood_fill it returns the same voxels and distances, because shortest paths and
/// the boxes of their moves contain nearer voxels only. Coordinates of the domain in [0, 2^17).
std::vector<FilledVoxel> flood_fill(const BlockSet& domain, glm::ivec3 source);

/// The voxels of flood_fill as a set, without the cost of their order.
Flood flood_set(const voxel::BitGrid& grid, glm::ivec3 source, std::uint32_t budget);
Flood flood_set(const BlockSet& domain, glm::ivec3 source);

}  // namespace brume::sim
