#include "sim/block_set.hpp"

#include <algorithm>
#include <string>

#include "core/error.hpp"

namespace brume::sim {
namespace {

constexpr int kMaxVoxel = 1 << 17;

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

  // Sort the runs and join those of one block.
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
    for (std::uint64_t bits = block.mask; bits != 0; bits &= bits - 1) {
      const glm::ivec3 v = voxel_of_block(glm::ivec3(block.at), std::countr_zero(bits));
      set.low_ = i == 0 && bits == block.mask ? v : glm::min(set.low_, v);
      set.high_ = i == 0 && bits == block.mask ? v : glm::max(set.high_, v);
    }
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
