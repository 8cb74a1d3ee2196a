#include "sim/block_set.hpp"

#include <algorithm>
#include <string>

#include "core/error.hpp"

namespace brume::sim {
namespace {

constexpr int kMaxVoxel = 1 << 17;

// Bits of a block's voxels in the first layer of x and of y.
constexpr std::uint64_t kFirstX = 0x1111111111111111u, kFirstY = 0x000f000f000f000fu;

/// Least and greatest of a block's voxels per axis; of at least one.
std::pair<glm::ivec3, glm::ivec3> bounds_of(std::uint64_t mask) {
  // Everything folded onto one row of each axis.
  const std::uint64_t layer = mask | mask >> 16 | mask >> 32 | mask >> 48;
  const auto xs = static_cast<unsigned>((layer | layer >> 4 | layer >> 8 | layer >> 12) & 0xf);
  unsigned ys = 0;
  for (unsigned y = 0; y < 4; ++y) ys |= unsigned{(layer >> (4 * y) & 0xf) != 0} << y;
  return {{std::countr_zero(xs), std::countr_zero(ys), std::countr_zero(mask) / 16},
          {std::bit_width(xs) - 1, std::bit_width(ys) - 1, (std::bit_width(mask) - 1) / 16}};
}

/// The voxels of `among` that a path over faces within `among` connects to `from`.
std::uint64_t spread_in_block(std::uint64_t from, std::uint64_t among) {
  for (;;) {
    const std::uint64_t next =
        (from | (from << 1 & ~kFirstX) | (from >> 1 & ~(kFirstX << 3)) | (from << 4 & ~kFirstY) |
         (from >> 4 & ~(kFirstY << 12)) | from << 16 | from >> 16) &
        among;
    if (next == from) return from;
    from = next;
  }
}

/// The voxels next to a block's voxels in the block across a face: -x, +x, -y, +y, -z, +z.
std::uint64_t across_face(std::uint64_t voxels, std::size_t face) {
  switch (face) {
    case 0:
      return (voxels & kFirstX) << 3;
    case 1:
      return voxels >> 3 & kFirstX;
    case 2:
      return (voxels & kFirstY) << 12;
    case 3:
      return voxels >> 12 & kFirstY;
    case 4:
      return voxels << 48;
    default:
      return voxels >> 48;
  }
}

}  // namespace

BlockSet::BlockSet(std::span<const glm::ivec3> voxels) {
  // Consecutive voxels are mostly of one block: gather them into runs.
  std::vector<VoxelBlock> runs;
  for (const glm::ivec3 v : voxels) {
    BRUME_ASSERT(glm::all(glm::greaterThanEqual(v, glm::ivec3(-kMaxVoxel))) &&
                     glm::all(glm::lessThan(v, glm::ivec3(kMaxVoxel))),
                 std::to_string(v.x) + "," + std::to_string(v.y) + "," + std::to_string(v.z));
    const glm::i16vec3 at(v >> 2);
    if (runs.empty() || runs.back().at != at) runs.push_back({at, 0, 0});
    runs.back().mask |= std::uint64_t{1} << block_bit_index(v);
  }

  // Sort the runs, and join the runs of one block.
  std::sort(runs.begin(), runs.end(),
            [](const VoxelBlock& a, const VoxelBlock& b) { return block_before(a.at, b.at); });
  std::vector<VoxelBlock> blocks;
  for (const VoxelBlock& run : runs) {
    if (!blocks.empty() && blocks.back().at == run.at)
      blocks.back().mask |= run.mask;
    else
      blocks.push_back(run);
  }
  *this = from_blocks(std::move(blocks));
}

BlockSet BlockSet::from_blocks(std::vector<VoxelBlock> blocks) {
  BlockSet set;
  set.blocks_ = std::move(blocks);
  set.blocks_.shrink_to_fit();
  for (std::size_t i = 0; i < set.blocks_.size(); ++i) {
    VoxelBlock& block = set.blocks_[i];
    BRUME_ASSERT(block.mask != 0, "an empty block");
    BRUME_ASSERT(i == 0 || block_before(set.blocks_[i - 1].at, block.at), "blocks out of order");
    block.first = set.size_;
    set.size_ += static_cast<std::uint32_t>(std::popcount(block.mask));
    const auto [low, high] = bounds_of(block.mask);
    const glm::ivec3 corner = voxel_of_block(glm::ivec3(block.at), 0);
    set.low_ = i == 0 ? corner + low : glm::min(set.low_, corner + low);
    set.high_ = i == 0 ? corner + high : glm::max(set.high_, corner + high);
  }
  return set;
}

const VoxelBlock* BlockSet::find_block(glm::ivec3 block) const {
  const glm::i16vec3 at(block);
  const auto found =
      std::lower_bound(blocks_.begin(), blocks_.end(), at,
                       [](const VoxelBlock& b, glm::i16vec3 wanted) { return block_before(b.at, wanted); });
  return found == blocks_.end() || glm::ivec3(found->at) != block ? nullptr : &*found;
}

std::uint32_t BlockSet::rank(glm::ivec3 voxel) const {
  if (glm::any(glm::lessThan(voxel, low_)) || glm::any(glm::greaterThan(voxel, high_))) return kNone;
  const VoxelBlock* block = find_block(voxel >> 2);
  const std::uint64_t bit = std::uint64_t{1} << block_bit_index(voxel);
  if (!block || !(block->mask & bit)) return kNone;
  return block->first + static_cast<std::uint32_t>(std::popcount(block->mask & (bit - 1)));
}

BlockSet connected_part(const BlockSet& set, glm::ivec3 voxel) {
  const std::span<const VoxelBlock> blocks = set.blocks();
  std::vector<std::uint64_t> reached(blocks.size(), 0);
  std::vector<const VoxelBlock*> open;  // with voxels reached that have not spread
  const auto reach = [&](glm::ivec3 at, std::uint64_t voxels) {
    const VoxelBlock* block = voxels != 0 ? set.find_block(at) : nullptr;
    if (!block) return;
    std::uint64_t& of_block = reached[static_cast<std::size_t>(block - blocks.data())];
    if ((voxels & block->mask & ~of_block) == 0) return;
    of_block = spread_in_block(of_block | (voxels & block->mask), block->mask);
    open.push_back(block);
  };
  reach(voxel >> 2, std::uint64_t{1} << block_bit_index(voxel));
  while (!open.empty()) {
    const VoxelBlock& block = *open.back();
    open.pop_back();
    const std::uint64_t voxels = reached[static_cast<std::size_t>(&block - blocks.data())];
    for (std::size_t face = 0; face < 6; ++face) {
      glm::ivec3 at(block.at);
      at[static_cast<int>(face / 2)] += face % 2 == 0 ? -1 : 1;
      reach(at, across_face(voxels, face));
    }
  }

  std::vector<VoxelBlock> connected;
  for (std::size_t i = 0; i < blocks.size(); ++i)
    if (reached[i] != 0) connected.push_back({blocks[i].at, reached[i], 0});
  return BlockSet::from_blocks(std::move(connected));
}

BlockSet unite(const BlockSet& a, const BlockSet& b) {
  std::vector<VoxelBlock> blocks;
  auto of_a = a.blocks().begin();
  auto of_b = b.blocks().begin();
  while (of_a != a.blocks().end() || of_b != b.blocks().end()) {
    if (of_b == b.blocks().end() || (of_a != a.blocks().end() && block_before(of_a->at, of_b->at)))
      blocks.push_back(*of_a++);
    else if (of_a == a.blocks().end() || block_before(of_b->at, of_a->at))
      blocks.push_back(*of_b++);
    else {
      blocks.push_back({of_a->at, of_a->mask | of_b->mask, 0});
      ++of_a, ++of_b;
    }
  }
  return BlockSet::from_blocks(std::move(blocks));
}

std::uint32_t count_common(const BlockSet& a, const BlockSet& b) {
  std::uint32_t count = 0;
  for (const VoxelBlock& block : a.blocks())
    if (const VoxelBlock* other = b.find_block(glm::ivec3(block.at)))
      count += static_cast<std::uint32_t>(std::popcount(block.mask & other->mask));
  return count;
}

}  // namespace brume::sim
