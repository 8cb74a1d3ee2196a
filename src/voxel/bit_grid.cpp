#include "voxel/bit_grid.hpp"

#include <bit>

#include "core/error.hpp"

namespace brume::voxel {

BitGrid::BitGrid(const GridLayout& layout) : layout_(layout), root_size_((layout.size + 63) >> 6) {
  for (int axis = 0; axis < 3; ++axis) {
    BRUME_ASSERT(layout.size[axis] >= 1 && layout.size[axis] <= kMaxAxis, std::to_string(layout.size[axis]));
  }
  root_.resize(root_index(root_size_ - 1) + 1);
}

BitGrid::Brick& BitGrid::ensure_brick(glm::ivec3 b) {
  std::uint32_t& node = root_[root_index(b >> 3)];
  if (node == 0) {
    nodes_.emplace_back().fill(0);
    node = static_cast<std::uint32_t>(nodes_.size());
  }
  std::uint32_t& brick = nodes_[node - 1][node_index(b)];
  if (brick == 0) {
    bricks_.emplace_back().fill(0);
    brick = static_cast<std::uint32_t>(bricks_.size());
  }
  return bricks_[brick - 1];
}

void BitGrid::set(glm::ivec3 v, bool solid) {
  BRUME_ASSERT(contains(v), std::to_string(v.x) + "," + std::to_string(v.y) + "," + std::to_string(v.z));
  if (!solid && !find_brick(v >> 3)) return;
  std::uint64_t& word = ensure_brick(v >> 3)[static_cast<unsigned>(v.z & 7)];
  const std::uint64_t bit = std::uint64_t{1} << ((v.x & 7) + 8 * (v.y & 7));
  word = solid ? word | bit : word & ~bit;
}

std::uint64_t BitGrid::count_solid() const {
  std::uint64_t count = 0;
  for (const Brick& brick : bricks_)
    for (const std::uint64_t word : brick) count += static_cast<std::uint64_t>(std::popcount(word));
  return count;
}

std::uint64_t BitGrid::bytes() const {
  return root_.size() * sizeof(root_[0]) + nodes_.size() * sizeof(nodes_[0]) +
         bricks_.size() * sizeof(bricks_[0]);
}

bool same_voxels(const BitGrid& a, const BitGrid& b) {
  if (a.layout() != b.layout()) return false;
  // An allocated brick may be empty.
  constexpr BitGrid::Brick kEmpty{};
  const auto has_bricks_of = [&](const BitGrid& one, const BitGrid& other) {
    bool same = true;
    one.for_each_brick([&](glm::ivec3 at, const BitGrid::Brick& brick) {
      const BitGrid::Brick* const found = other.find_brick(at);
      same = same && brick == (found ? *found : kEmpty);
    });
    return same;
  };
  return has_bricks_of(a, b) && has_bricks_of(b, a);
}

}  // namespace brume::voxel
