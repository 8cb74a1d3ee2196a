// A set of voxels as 64-bit masks of 4^3 blocks, in memory and on the wire: what a cloud fills, an explosion
// reaches or an edit changes. Each voxel of the set has a rank, so that per-voxel data are plain arrays
// beside the set.
//
//   blocks  sorted by (z, y, x):  | at | mask | first |     mask bit x + 4 y + 16 z of the voxel in its block
//   rank of a voxel = first of its block + set bits below its own
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <utility>
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

/// Calls visit(voxel, rank, rank in `other` or kNone) for each voxel of `set` in rank order.
template <typename Visit>
void for_each_with(const BlockSet& set, const BlockSet& other, Visit visit);
/// The voxels that keep(voxel, rank) accepts, which is called in rank order.
template <typename Keep>
BlockSet filter(const BlockSet& set, Keep keep);
/// The voxels that a path over faces within the set connects to one of its voxels; none when it lacks that.
BlockSet connected_part(const BlockSet& set, glm::ivec3 voxel);
/// The union of both sets.
BlockSet unite(const BlockSet& a, const BlockSet& b);
/// The number of voxels in both sets.
std::uint32_t count_common(const BlockSet& a, const BlockSet& b);

/// The voxels of a block of a brick of 8^3 voxels (word z, bit x + 8 y), `corner` in [0, 1]^3.
inline std::uint64_t block_of(const std::array<std::uint64_t, 8>& brick, glm::ivec3 corner) {
  std::uint64_t mask = 0;
  for (int z = 0; z < kBlockSize; ++z) {
    // Rows of four bits, eight apart, moved next to each other.
    std::uint64_t rows = brick[static_cast<std::size_t>(4 * corner.z + z)] >> (4 * corner.x + 32 * corner.y);
    rows &= 0x0f0f0f0fu;
    rows = (rows | rows >> 4) & 0x00ff00ffu;
    mask |= ((rows | rows >> 8) & 0xffffu) << (16 * z);
  }
  return mask;
}

/// The order of blocks: by (z, y, x).
inline bool block_before(glm::i16vec3 a, glm::i16vec3 b) {
  return a.z != b.z ? a.z < b.z : a.y != b.y ? a.y < b.y : a.x < b.x;
}

template <typename Visit>
void for_each_with(const BlockSet& set, const BlockSet& other, Visit visit) {
  auto near = other.blocks().begin();
  for (const VoxelBlock& block : set.blocks()) {
    while (near != other.blocks().end() && block_before(near->at, block.at)) ++near;
    const bool common = near != other.blocks().end() && near->at == block.at;
    const std::uint64_t others = common ? near->mask : 0;
    std::uint32_t rank = block.first, other_rank = common ? near->first : 0;
    for (std::uint64_t bits = block.mask | others; bits != 0; bits &= bits - 1) {
      const int bit = std::countr_zero(bits);
      const bool in_other = (others >> bit & 1) != 0;
      if ((block.mask >> bit & 1) != 0)
        visit(voxel_of_block(glm::ivec3(block.at), bit), rank++, in_other ? other_rank : BlockSet::kNone);
      other_rank += in_other;
    }
  }
}

template <typename Keep>
BlockSet filter(const BlockSet& set, Keep keep) {
  std::vector<VoxelBlock> blocks;
  for (const VoxelBlock& block : set.blocks()) {
    std::uint64_t kept = 0;
    std::uint32_t rank = block.first;
    for (std::uint64_t bits = block.mask; bits != 0; bits &= bits - 1)
      if (keep(voxel_of_block(glm::ivec3(block.at), std::countr_zero(bits)), rank++))
        kept |= bits & (~bits + 1);
    if (kept != 0) blocks.push_back({block.at, kept, 0});
  }
  return BlockSet::from_blocks(std::move(blocks));
}

}  // namespace brume::sim
