// Small hollows that smoke cannot come into: the insides of columns, thick walls and furniture.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <memory>
#include <unordered_map>
#include <vector>

#include "smoke/smoke_brick.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::smoke {

/// Answers for single voxels, and remembers what it has learnt on the way, and for whom.
class SealedPockets {
 public:
  /// A space of this many voxels or more is a room, not a pocket.
  static constexpr std::size_t kLeastRoom = 4096;

  using HasSmoke = std::function<bool(glm::ivec3)>;

  /// True when the free voxels that can be reached from this one hold no smoke and are fewer than
  /// kLeastRoom. Moves over faces reach as far as those of flood_fill, whose longer moves need every voxel
  /// between free. `voxel` must be free and without smoke; `has_smoke` says of a free voxel whether a cloud
  /// ever fills it. The brick that asks is told by `changed` when the answer may be another.
  bool sealed(const voxel::BitGrid& grid, const HasSmoke& has_smoke, glm::ivec3 voxel, glm::ivec3 asker);

  /// Voxels of a brick became solid, free, with or without smoke: what was learnt of the spaces beside them
  /// is forgotten. Adds the bricks that had asked for those to `askers`.
  void changed(glm::ivec3 brick, const BrickBits& voxels, std::vector<glm::ivec3>& askers);

 private:
  /// Number of the space of each voxel of a brick; 0: unknown.
  struct Page {
    std::array<std::uint32_t, 512> space{};
    std::uint32_t known = 0;
  };
  struct Space {
    bool sealed = false;
    std::vector<glm::ivec3> bricks;  // that have voxels of it, some more than once
    std::vector<glm::ivec3> askers;
  };
  const Page* page_of(glm::ivec3 brick) const;
  std::uint32_t space_at(glm::ivec3 voxel) const;
  void put(glm::ivec3 voxel, std::uint32_t space, std::vector<glm::ivec3>& bricks);
  void forget(std::uint32_t space, std::vector<glm::ivec3>& askers);
  std::uint32_t explore(const voxel::BitGrid& grid, const HasSmoke& has_smoke, glm::ivec3 voxel);

  std::unordered_map<std::uint64_t, std::unique_ptr<Page>> pages_;
  std::unordered_map<std::uint32_t, Space> spaces_;
  std::uint32_t next_space_ = 1;
  std::vector<glm::ivec3> reached_;
};

}  // namespace brume::smoke
