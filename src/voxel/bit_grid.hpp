// Which voxels of the world are solid: a sparse grid of bits.
//
//   root   one entry per node of 64^3 voxels            -> node, or none
//   node   8^3 entries, one per brick of 8^3 voxels     -> brick, or none
//   brick  8 words of 64 bits; word z, bit x + 8 y      -> 1 = solid
//
// Only bricks with solid voxels are allocated: memory is proportional to the surfaces, not to the volume.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

namespace brume::voxel {

/// Placement of a grid in the world. Voxel i covers [i, i+1) in voxel space, its centre is i + 0.5;
/// position_voxel = (position_world - origin_world) / voxel_size.
struct GridLayout {
  glm::ivec3 size{0};         ///< Voxels per axis, each in [1, kMaxAxis].
  float voxel_size = 0.5f;    ///< Edge of a voxel [m], > 0.
  glm::vec3 origin_world{0};  ///< The low corner of voxel (0, 0, 0).
  bool operator==(const GridLayout&) const = default;
};

constexpr int kMaxAxis = 4096;
constexpr int kBrickSize = 8;

inline glm::vec3 voxel_from_world(const GridLayout& layout, glm::vec3 position_world) {
  return (position_world - layout.origin_world) / layout.voxel_size;
}
inline glm::vec3 world_from_voxel(const GridLayout& layout, glm::vec3 position_voxel) {
  return position_voxel * layout.voxel_size + layout.origin_world;
}

class BitGrid {
 public:
  using Brick = std::array<std::uint64_t, kBrickSize>;

  explicit BitGrid(const GridLayout& layout);

  const GridLayout& layout() const { return layout_; }
  glm::ivec3 size() const { return layout_.size; }
  bool contains(glm::ivec3 v) const {
    return v.x >= 0 && v.y >= 0 && v.z >= 0 && v.x < layout_.size.x && v.y < layout_.size.y &&
           v.z < layout_.size.z;
  }

  /// True when the voxel is solid; false outside the grid.
  bool solid(glm::ivec3 v) const {
    if (!contains(v)) return false;
    const Brick* brick = find_brick(v >> 3);
    return brick && ((*brick)[static_cast<unsigned>(v.z & 7)] >> ((v.x & 7) + 8 * (v.y & 7)) & 1);
  }
  /// True when the voxel is in the grid and not solid: it may hold smoke.
  bool free(glm::ivec3 v) const { return contains(v) && !solid(v); }

  /// The brick at brick coordinates (voxel / 8), or null when it is not allocated. `b` must lie in the grid.
  const Brick* find_brick(glm::ivec3 b) const {
    const std::uint32_t node = root_[root_index(b >> 3)];
    if (node == 0) return nullptr;
    const std::uint32_t brick = nodes_[node - 1][node_index(b)];
    return brick == 0 ? nullptr : &bricks_[brick - 1];
  }
  /// The same for writing. A brick that becomes empty stays allocated.
  Brick* find_brick_to_write(glm::ivec3 b) { return const_cast<Brick*>(find_brick(b)); }
  /// The brick, allocated if necessary. Invalidates pointers to other bricks.
  Brick& ensure_brick(glm::ivec3 b);

  /// `v` must lie in the grid.
  void set(glm::ivec3 v, bool solid);

  std::uint64_t count_solid() const;
  /// Bytes of memory held.
  std::uint64_t bytes() const;

  /// Calls visit(brick_coordinates, brick) for each allocated brick, in order of node, then of brick.
  template <typename Visit>
  void for_each_brick(Visit visit) const;

 private:
  std::size_t root_index(glm::ivec3 n) const {
    return static_cast<std::size_t>(n.x) +
           static_cast<std::size_t>(root_size_.x) *
               (static_cast<std::size_t>(n.y) +
                static_cast<std::size_t>(root_size_.y) * static_cast<std::size_t>(n.z));
  }
  static std::size_t node_index(glm::ivec3 b) {
    const glm::uvec3 in_node = glm::uvec3(b) & 7u;
    return in_node.x + 8u * in_node.y + 64u * in_node.z;
  }

  GridLayout layout_;
  glm::ivec3 root_size_;
  std::vector<std::uint32_t> root_;                    // node number + 1, 0: none
  std::vector<std::array<std::uint32_t, 512>> nodes_;  // brick number + 1, 0: none
  std::vector<Brick> bricks_;
};

/// Whether both have one layout and the same voxels solid.
bool same_voxels(const BitGrid& a, const BitGrid& b);

template <typename Visit>
void BitGrid::for_each_brick(Visit visit) const {
  for (int z = 0; z < root_size_.z; ++z)
    for (int y = 0; y < root_size_.y; ++y)
      for (int x = 0; x < root_size_.x; ++x) {
        const std::uint32_t node = root_[root_index({x, y, z})];
        if (node == 0) continue;
        for (int i = 0; i < 512; ++i) {
          const std::uint32_t brick = nodes_[node - 1][static_cast<std::size_t>(i)];
          if (brick != 0)
            visit(glm::ivec3(x, y, z) * 8 + glm::ivec3(i & 7, i >> 3 & 7, i >> 6), bricks_[brick - 1]);
        }
      }
}

}  // namespace brume::voxel
