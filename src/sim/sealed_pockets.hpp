// Small hollows that smoke cannot come into: the insides of columns, thick walls and furniture.
#pragma once

#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <unordered_map>
#include <vector>

#include "voxel/bit_grid.hpp"

namespace brume::sim {

/// Answers for single voxels, and remembers what it has learnt on the way.
class SealedPockets {
 public:
  /// A space of this many voxels or more is a room, not a pocket.
  static constexpr std::size_t kLeastRoom = 4096;

  /// `has_smoke` says of a free voxel whether a cloud ever fills it.
  SealedPockets(const voxel::BitGrid& grid, std::function<bool(glm::ivec3)> has_smoke)
      : grid_(grid), has_smoke_(std::move(has_smoke)) {}

  /// True when the free voxels that can be reached from this one hold no smoke and are fewer than
  /// kLeastRoom. Moves over faces reach as far as those of flood_fill, whose longer moves need every voxel
  /// between free. `voxel` must be free.
  bool sealed(glm::ivec3 voxel);

 private:
  const voxel::BitGrid& grid_;
  std::function<bool(glm::ivec3)> has_smoke_;
  std::unordered_map<std::uint64_t, bool> known_;
  std::vector<glm::ivec3> reached_;
};

}  // namespace brume::sim
