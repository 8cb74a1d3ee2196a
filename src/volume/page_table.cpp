#include "volume/page_table.hpp"

#include <algorithm>

namespace brume::volume {

void PageTable::set_entry(glm::ivec3 brick, std::uint32_t value) {
  std::uint32_t node = node_at(brick >> 3);
  if (node == kNoNode) {
    if (value == 0) return;
    node = take_node(brick >> 3);
  }
  Node& info = info_[node];
  std::uint32_t& entry = nodes_[first_of(node) + local_of(brick)];
  if (entry == value) return;
  info.used += (value != 0) - (entry != 0);
  entry = value;
  if (!info.changed) changed_nodes_.push_back(node);
  info.changed = true;
  if (info.used == 0) drop_node(node);
}

/// Allocates the node at a place and enters it in the root.
std::uint32_t PageTable::take_node(glm::ivec3 at) {
  std::uint32_t node = static_cast<std::uint32_t>(info_.size());
  if (free_nodes_.empty()) {
    info_.emplace_back();
    nodes_.resize(nodes_.size() + shared::kPageEntries);
  } else {
    node = free_nodes_.back();
    free_nodes_.pop_back();
  }
  info_[node].at = at;
  if (size_ == glm::ivec3(0)) {
    set_window(at, glm::ivec3(1));
  } else {
    const glm::ivec3 low = glm::min(origin_, at), high = glm::max(origin_ + size_, at + 1);
    if (low != origin_ || high != origin_ + size_) set_window(low, high - low);
  }
  root_[entry_of(at - origin_)] = shared::kFirstNode + node;
  root_changed_ = true;
  return node;
}

void PageTable::drop_node(std::uint32_t node) {
  const glm::ivec3 at = info_[node].at;
  root_[entry_of(at - origin_)] = 0;
  root_changed_ = true;
  free_nodes_.push_back(node);
  // Only a node at the window's face may have held it open.
  if (!glm::any(glm::equal(at, origin_)) && !glm::any(glm::equal(at, origin_ + size_ - 1))) return;
  glm::ivec3 low(0), high(0);
  bool any = false;
  for (const Node& other : info_) {
    if (other.used == 0) continue;
    low = any ? glm::min(low, other.at) : other.at;
    high = any ? glm::max(high, other.at + 1) : other.at + 1;
    any = true;
  }
  if (low != origin_ || high - low != size_) set_window(low, high - low);
}

void PageTable::set_window(glm::ivec3 origin, glm::ivec3 size) {
  origin_ = origin;
  size_ = size;
  const glm::u64vec3 entries(size);
  root_.assign(entries.x * entries.y * entries.z, 0);
  for (std::size_t node = 0; node < info_.size(); ++node)
    if (info_[node].used > 0)
      root_[entry_of(info_[node].at - origin_)] = shared::kFirstNode + static_cast<std::uint32_t>(node);
  root_changed_ = true;
}

/// Chessboard distances in two sweeps: A. Rosenfeld, J. Pfaltz, "Sequential operations in digital picture
/// processing", 1966.
void PageTable::find_distances() {
  for (std::uint32_t& entry : root_)
    if (entry < shared::kFirstNode) entry = shared::kFirstNode - 1;
  for (const int way : {1, -1}) {
    const glm::ivec3 first = way > 0 ? glm::ivec3(0) : size_ - 1, behind = way > 0 ? size_ : glm::ivec3(-1);
    for (int z = first.z; z != behind.z; z += way)
      for (int y = first.y; y != behind.y; y += way)
        for (int x = first.x; x != behind.x; x += way) near_swept({x, y, z}, way);
  }
  root_changed_ = true;
}

/// One more than the least of the neighbours that a sweep came by before.
void PageTable::near_swept(glm::ivec3 at, int way) {
  std::uint32_t& entry = root_[entry_of(at)];
  if (entry >= shared::kFirstNode) return;
  for (int n = 0; n < 13; ++n) {
    const glm::ivec3 beside = at + way * (glm::ivec3(n % 3, n / 3 % 3, n / 9) - 1);
    if (glm::any(glm::lessThan(beside, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(beside, size_)))
      continue;
    const std::uint32_t other = root_[entry_of(beside)];
    entry = std::min(entry, other < shared::kFirstNode ? other + 1 : 1);
  }
}

/// The box around all nodes that are connected with one, through faces, edges and corners.
Box<int> PageTable::group_around(std::uint32_t first, std::vector<bool>& seen) const {
  Box<int> box{info_[first].at, info_[first].at + 1};
  std::vector<std::uint32_t> left{first};
  seen[first] = true;
  while (!left.empty()) {
    const glm::ivec3 at = info_[left.back()].at;
    left.pop_back();
    box = united(box, {at, at + 1});
    for (int n = 0; n < 27; ++n) {
      const std::uint32_t beside = node_at(at + glm::ivec3(n % 3, n / 3 % 3, n / 9) - 1);
      if (beside == kNoNode || seen[beside]) continue;
      seen[beside] = true;
      left.push_back(beside);
    }
  }
  return box;
}

std::vector<Box<int>> PageTable::groups(std::size_t most) const {
  constexpr std::size_t kMostGroups = 16;  // beyond, pairs take too long to compare
  std::vector<Box<int>> boxes;
  std::vector<bool> seen(info_.size());
  for (std::uint32_t node = 0; node < info_.size(); ++node) {
    if (info_[node].used == 0 || seen[node]) continue;
    if (boxes.size() == kMostGroups) return {{origin_, origin_ + size_}};
    boxes.push_back(group_around(node, seen));
  }
  join_nearest(boxes, most);
  return boxes;
}

void PageTable::clear_changes() {
  for (const std::uint32_t node : changed_nodes_) info_[node].changed = false;
  changed_nodes_.clear();
  root_changed_ = false;
}

}  // namespace brume::volume
