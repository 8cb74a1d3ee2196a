// A set of voxels as 64-bit masks of 4^3 blocks: what clouds, blasts and edits are made of, and how they
// displacements. Each voxel of the set has a rank, so that data of the voxels are plain arrays beside it.
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
  /// The set of these voxels, in any order, also more than once. Coordinates within [-2^17, 2^17).
  explicit BlockSet(std::span<const glm::ivec3> voxels);
  /// From blocks sorted by (z, y, x), no two alike, no mask 0; `first` is counted anew.
  static BlockSet from_blocks(std::vector<VoxelBlock> blocks);

  std::span<const VoxelBlock> blocks() const { return blocks_; }
  std::uint32_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// The block, or null when none of its voxels is in the set.
  const VoxelBlock* find_block(glm::ivec3 block) const;
  bool contains(glm::ivec3 voxel) const { return rank(voxel) != kNone; }
  /// Number of the voxel in [0, size), by block and bit; kNone when it is not in the set.
  std::uint32_t rank(glm::ivec3 voxel) const;

  /// Low corner of the lowest and high corner of the highest voxel, by axis; of an empty set low > high.
  glm::ivec3 low() const { return low_; }
  glm::ivec3 high() const { return high_; }

  /// Calls visit(voxel, rank) for each voxel in the order of ranks.
  template <typename Visit>
  void for_each(Visit visit) const {
    for (const VoxelBlock& block : blocks_) {
      std::uint32_t rank = block.first;
      for (std::uint64_t left = block.mask; left != 0; left &= left - 1)
        visit(voxel_of_block(glm::ivec3(block.at), std::countr_zero(left)), rank++);
    }
  }

  std::uint64_t bytes() const { return blocks_.size() * sizeof(VoxelBlock); }
  bool operator==(const BlockSet& other) const { return blocks_ == other.blocks_; }

 private:
  std::vector<VoxelBlock> blocks_;
  std::uint32_t size_ = 0;
  glm::ivec3 low_{0}, high_{-1};
};

/// The voxels of both.
BlockSet unite(const BlockSet& a, const BlockSet& b);
/// How many voxels are in both.
std::uint32_t count_common(const BlockSet& a, const BlockSet& b);

/// The order of blocks.
inline bool block_before(glm::i16vec3 a, glm::i16vec3 b) {
  return a.z != b.z ? a.z < b.z : a.y != b.y ? a.y < b.y : a.x < b.x;
}

}  // namespace brume::sim
