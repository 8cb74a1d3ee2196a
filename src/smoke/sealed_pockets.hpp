// Small hollows that smoke cannot enter: the insides of columns, thick walls and furniture.
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

/// Classifies single voxels. Caches the spaces explored, and which bricks queried them.
class SealedPockets {
 public:
  /// A space of this many voxels or more is a room, not a pocket.
  static constexpr std::size_t kLeastRoom = 4096;

  using HasSmoke = std::function<bool(glm::ivec3)>;

  /// True when the free voxels that can be reached from this one hold no smoke and are fewer than
  /// kLeastRoom. Moves over faces reach as far as flood_fill, whose longer moves require every voxel
  /// between to be free. `voxel` must be free and without smoke; `has_smoke` is whether a cloud ever fills a
  /// free voxel. `changed` reports `brick`, which queries, when the result may differ.
  bool sealed(const voxel::BitGrid& grid, const HasSmoke& has_smoke, glm::ivec3 voxel, glm::ivec3 brick);

  /// Voxels of a brick became solid, free, with or without smoke: invalidates the spaces beside them. Appends
  /// the bricks that queried those to `stale`.
  void changed(glm::ivec3 brick, const BrickBits& voxels, std::vector<glm::ivec3>& stale);

 private:
  /// Number of the space of each voxel of a brick; 0: unknown.
  struct Page {
    std::array<std::uint32_t, 512> space{};
    std::uint32_t known = 0;
  };
  struct Space {
    bool sealed = false;
    std::vector<glm::ivec3> bricks;  // with voxels of it, some more than once
    std::vector<glm::ivec3> queried_by;
  };
  const Page* page_of(glm::ivec3 brick) const;
  std::uint32_t space_at(glm::ivec3 voxel) const;
  void put(glm::ivec3 voxel, std::uint32_t space, std::vector<glm::ivec3>& bricks);
  void invalidate(std::uint32_t space, std::vector<glm::ivec3>& stale);
  std::uint32_t explore(const voxel::BitGrid& grid, const HasSmoke& has_smoke, glm::ivec3 voxel);

  std::unordered_map<std::uint64_t, std::unique_ptr<Page>> pages_;
  std::unordered_map<std::uint32_t, Space> spaces_;
  std::uint32_t next_space_ = 1;
  std::vector<glm::ivec3> reached_;
};

}  // namespace brume::smoke
