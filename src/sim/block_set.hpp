// A set of voxels as 64-bit masks of 4^3 blocks: the representation of clouds, blasts and edits in memory and
// on the wire. Each voxel of the set has a rank, so that per-voxel data are plain arrays beside the set.
//
//   blocks  sorted by (z, y, x):  | at | mask | first |     mask bit x + 4 y + 16 z of the voxel in its block
//   rank of a voxel = first of its block + set bits below its own
#pragma once

#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace brume::sim {

constexpr int kBlockSize = 4;

struct VoxelBlock {
  glm::i16vec3 at{0};       ///< Block coordinates: voxel / 4, rounded down.
  std::uint64_t mask = 0;   ///< Never 0.
  std::uint32_t first = 0;  ///< Rank of its first voxel.
  bool operator==(const VoxelBlock&) const = default;
};

constexpr int block_bit_index(glm::ivec3 v) {
  return (v.x & 3) + 4 * (v.y & 3) + 16 * (v.z & 3);
}
inline glm::ivec3 voxel_of_block(glm::ivec3 block, int bit) {
  return block * kBlockSize + glm::ivec3(bit & 3, bit >> 2 & 3, bit >> 4);
}

class BlockSet {
 public:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  BlockSet() = default;
  /// The set of these voxels, in any order, duplicates allowed. Coordinates within [-2^17, 2^17).
  explicit BlockSet(std::span<const glm::ivec3> voxels);
  /// From blocks sorted by (z, y, x), all distinct, no mask 0; `first` is recomputed.
  static BlockSet from_blocks(std::vector<VoxelBlock> blocks);

  std::span<const VoxelBlock> blocks() const { return blocks_; }
  std::uint32_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// The block, or null when the set has no voxel in it.
  const VoxelBlock* find_block(glm::ivec3 block) const;
  bool contains(glm::ivec3 voxel) const { return rank(voxel) != kNone; }
  /// Rank of the voxel in [0, size), in the order of blocks and bits; kNone when it is not in the set.
  std::uint32_t rank(glm::ivec3 voxel) const;

  /// Per-axis minimum and maximum of the voxels; of an empty set low > high.
  glm::ivec3 low() const { return low_; }
  glm::ivec3 high() const { return high_; }

  /// Calls visit(voxel, rank) for each voxel in rank order.
  template <typename Visit>
  void for_each(Visit visit) const {
    for (const VoxelBlock& block : blocks_) {
      std::uint32_t rank = block.first;
      for (std::uint64_t bits = block.mask; bits != 0; bits &= bits - 1)
        visit(voxel_of_block(glm::ivec3(block.at), std::countr_zero(bits)), rank++);
    }
  }

  std::uint64_t bytes() const { return blocks_.size() * sizeof(VoxelBlock); }
  bool operator==(const BlockSet& other) const { return blocks_ == other.blocks_; }

 private:
  std::vector<VoxelBlock> blocks_;
  std::uint32_t size_ = 0;
  glm::ivec3 low_{0}, high_{-1};
};

/// The union of both sets.
BlockSet unite(const BlockSet& a, const BlockSet& b);
/// The number of voxels in both sets.
std::uint32_t count_common(const BlockSet& a, const BlockSet& b);

/// The order of blocks: by (z, y, x).
inline bool block_before(glm::i16vec3 a, glm::i16vec3 b) {
  return a.z != b.z ? a.z < b.z : a.y != b.y ? a.y < b.y : a.x < b.x;
}

}  // namespace brume::sim
