// Which slot a brick has: a table of two levels, so that memory follows the bricks and not the space between
// them.
//
//   root   one entry per node of 8^3 bricks of a window of the world  -> node, or none
//   node   8^3 entries, one per brick                                 -> slot, or none
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/box.hpp"
#include "shared/volume.h"

namespace brume::volume {

class PageTable {
 public:
  static constexpr std::uint32_t kNoSlot = ~std::uint32_t{0};

  /// Whether an entry of a node is slot + 1: neither 0 nor the number of a uniform brick.
  static bool is_slot(std::uint32_t entry) { return entry != 0 && (entry & shared::kUniformBrick) == 0; }
  /// The slot of a brick, or kNoSlot.
  std::uint32_t at(glm::ivec3 brick) const {
    const std::uint32_t node = node_at(brick >> 3);
    const std::uint32_t entry = node == kNoNode ? 0 : nodes_[first_of(node) + local_of(brick)];
    return is_slot(entry) ? entry - 1 : kNoSlot;
  }
  /// The texel of a uniform brick, a half float.
  std::optional<std::uint16_t> uniform_at(glm::ivec3 brick) const {
    const std::uint32_t node = node_at(brick >> 3);
    const std::uint32_t entry = node == kNoNode ? 0 : nodes_[first_of(node) + local_of(brick)];
    if ((entry & shared::kUniformBrick) == 0) return std::nullopt;
    return static_cast<std::uint16_t>(entry);
  }
  /// Sets the slot of a brick; kNoSlot removes the brick. The window becomes the smallest around all nodes
  /// that hold a brick.
  void set(glm::ivec3 brick, std::uint32_t slot) { set_entry(brick, slot + 1); }
  /// Makes a brick uniform: all its texels are this half float, and it has no slot.
  void set_uniform(glm::ivec3 brick, std::uint16_t texel) { set_entry(brick, shared::kUniformBrick | texel); }
  /// Writes into the root's empty entries how far the nearest node is. Until then they are 0.
  void find_distances();

  /// At most `most` boxes, together around all nodes that hold a brick: each around nodes that touch, or,
  /// where there are more such groups, around several of them [nodes].
  std::vector<Box<int>> groups(std::size_t most) const;

  /// The window [nodes]; without any brick both are 0.
  glm::ivec3 origin() const { return origin_; }
  glm::ivec3 size() const { return size_; }
  /// shared::kFirstNode + node, or a distance: x + size.x (y + size.y z).
  std::span<const std::uint32_t> root() const { return root_; }
  /// Slot + 1, 0, or the number of a uniform brick, kPageEntries a node: x + 8 (y + 8 z). Free nodes hold 0.
  std::span<const std::uint32_t> nodes() const { return nodes_; }

  /// Whether the root changed since the last clear_changes, and which nodes did, in no order.
  bool root_changed() const { return root_changed_; }
  std::span<const std::uint32_t> changed_nodes() const { return changed_nodes_; }
  void clear_changes();

 private:
  static constexpr std::uint32_t kNoNode = ~std::uint32_t{0};
  struct Node {
    glm::ivec3 at{0};
    std::uint32_t used = 0;  // bricks with a slot; 0: the node is free
    bool changed = false;
  };
  static std::size_t first_of(std::uint32_t node) { return std::size_t{node} * shared::kPageEntries; }
  static std::size_t local_of(glm::ivec3 brick) {
    return static_cast<std::size_t>((brick.x & 7) + 8 * (brick.y & 7) + 64 * (brick.z & 7));
  }
  std::size_t entry_of(glm::ivec3 n) const {
    const glm::u64vec3 at(n), size(size_);
    return at.x + size.x * (at.y + size.y * at.z);
  }
  std::uint32_t node_at(glm::ivec3 node) const {
    const glm::ivec3 n = node - origin_;
    if (n.x < 0 || n.y < 0 || n.z < 0 || n.x >= size_.x || n.y >= size_.y || n.z >= size_.z) return kNoNode;
    const std::uint32_t entry = root_[entry_of(n)];
    return entry < shared::kFirstNode ? kNoNode : entry - shared::kFirstNode;
  }
  void set_entry(glm::ivec3 brick, std::uint32_t entry);
  std::uint32_t take_node(glm::ivec3 at);
  void drop_node(std::uint32_t node);
  void set_window(glm::ivec3 origin, glm::ivec3 size);
  void sweep_row(int y, int z, int way);
  Box<int> group_around(std::uint32_t first, std::vector<bool>& seen) const;

  glm::ivec3 origin_{0}, size_{0};
  std::vector<std::uint32_t> root_, nodes_;
  std::vector<Node> info_;
  std::vector<std::uint32_t> free_nodes_;
  std::vector<std::uint32_t> changed_nodes_;
  bool root_changed_ = false;
};

}  // namespace brume::volume
