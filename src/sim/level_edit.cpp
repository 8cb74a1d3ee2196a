#include "sim/level_edit.hpp"

#include <algorithm>
#include <bit>

namespace brume::sim {
namespace {

/// The bits of the block's voxels within [low, high).
std::uint64_t bits_within(glm::ivec3 block, glm::ivec3 low, glm::ivec3 high) {
  const glm::ivec3 first = glm::max(low - block * kBlockSize, glm::ivec3(0));
  const glm::ivec3 end = glm::min(high - block * kBlockSize, glm::ivec3(kBlockSize));
  std::uint64_t bits = 0;
  for (int z = first.z; z < end.z; ++z)
    for (int y = first.y; y < end.y; ++y)
      for (int x = first.x; x < end.x; ++x) bits |= std::uint64_t{1} << block_bit_index({x, y, z});
  return bits;
}

/// Calls visit(block) in order for each block that contains voxels of [low, high).
template <typename Visit>
void for_each_block(glm::ivec3 low, glm::ivec3 high, Visit visit) {
  if (glm::any(glm::greaterThanEqual(low, high))) return;
  const glm::ivec3 first = low >> 2, last = (high - 1) >> 2;
  for (int z = first.z; z <= last.z; ++z)
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) visit(glm::ivec3(x, y, z));
}

}  // namespace

std::uint64_t solid_bits(const voxel::BitGrid& grid, glm::ivec3 block) {
  const glm::ivec3 bricks = (grid.size() + voxel::kBrickSize - 1) / voxel::kBrickSize;
  const glm::ivec3 at = block >> 1;
  if (glm::any(glm::lessThan(at, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(at, bricks))) return 0;
  const voxel::BitGrid::Brick* brick = grid.find_brick(at);
  if (!brick) return 0;
  const glm::ivec3 corner = (block & 1) * kBlockSize;
  std::uint64_t bits = 0;
  for (int z = 0; z < kBlockSize; ++z) {
    const std::uint64_t slice = (*brick)[static_cast<std::size_t>(corner.z + z)];
    for (int y = 0; y < kBlockSize; ++y)
      bits |= (slice >> (corner.x + 8 * (corner.y + y)) & 0xf) << (4 * y + 16 * z);
  }
  return bits;
}

EditBlocks edit_box(const voxel::GridLayout& layout, glm::ivec3 low, glm::ivec3 high, bool solid) {
  low = glm::max(low, glm::ivec3(0));
  high = glm::min(high, layout.size);
  EditBlocks edits;
  for_each_block(low, high, [&](glm::ivec3 block) {
    const std::uint64_t bits = bits_within(block, low, high);
    edits.push_back({glm::i16vec3(block), solid ? bits : 0, solid ? 0 : bits});
  });
  return edits;
}

EditBlocks difference(const voxel::BitGrid& from, const voxel::BitGrid& to, glm::ivec3 low, glm::ivec3 high) {
  low = glm::max(low, glm::ivec3(0));
  high = glm::min(high, from.size());
  EditBlocks edits;
  for_each_block(low, high, [&](glm::ivec3 block) {
    const std::uint64_t within = bits_within(block, low, high);
    const std::uint64_t before = solid_bits(from, block) & within, after = solid_bits(to, block) & within;
    if (before != after) edits.push_back({glm::i16vec3(block), after & ~before, before & ~after});
  });
  return edits;
}

EditBlocks merge_edits(std::span<const EditBlock> earlier, std::span<const EditBlock> later) {
  EditBlocks merged;
  auto a = earlier.begin();
  auto b = later.begin();
  while (a != earlier.end() || b != later.end()) {
    if (b == later.end() || (a != earlier.end() && block_before(a->at, b->at)))
      merged.push_back(*a++);
    else if (a == earlier.end() || block_before(b->at, a->at))
      merged.push_back(*b++);
    else {
      merged.push_back({a->at, (a->make_solid & ~b->make_free) | b->make_solid,
                        (a->make_free & ~b->make_solid) | b->make_free});
      ++a, ++b;
    }
  }
  return merged;
}

EditBlocks effective_edits(const voxel::BitGrid& grid, std::span<const EditBlock> edits) {
  EditBlocks effective;
  for (const EditBlock& edit : edits) {
    const std::uint64_t solid = solid_bits(grid, glm::ivec3(edit.at));
    const std::uint64_t within = bits_within(glm::ivec3(edit.at), glm::ivec3(0), grid.size());
    const EditBlock change{edit.at, edit.make_solid & ~solid & within, edit.make_free & solid};
    if (change.make_solid | change.make_free) effective.push_back(change);
  }
  return effective;
}

void apply_edits(voxel::BitGrid& grid, std::span<const EditBlock> edits) {
  for (const EditBlock& edit : edits)
    for (std::uint64_t bits = edit.make_solid | edit.make_free; bits != 0; bits &= bits - 1) {
      const int bit = std::countr_zero(bits);
      const glm::ivec3 v = voxel_of_block(glm::ivec3(edit.at), bit);
      if (grid.contains(v)) grid.set(v, edit.make_solid >> bit & 1);
    }
}

}  // namespace brume::sim
