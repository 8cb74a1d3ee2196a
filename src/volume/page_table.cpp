#include "volume/page_table.hpp"

#include <algorithm>
#include <array>

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
  for (const int way : {1, -1})
    for (int z = way > 0 ? 0 : size_.z - 1; z >= 0 && z < size_.z; z += way)
      for (int y = way > 0 ? 0 : size_.y - 1; y >= 0 && y < size_.y; y += way) sweep_row(y, z, way);
  root_changed_ = true;
}

/// In a row along x: one more than the least of the neighbours that the sweep came by before.
void PageTable::sweep_row(int y, int z, int way) {
  std::array<const std::uint32_t*, 4> rows;
  std::size_t rows_swept = 0;
  for (const glm::ivec2 step : {glm::ivec2(-1, -1), {0, -1}, {1, -1}, {-1, 0}}) {
    const glm::ivec2 beside = glm::ivec2(y, z) + way * step;
    if (beside.x >= 0 && beside.y >= 0 && beside.x < size_.y && beside.y < size_.z)
      rows[rows_swept++] = &root_[entry_of({0, beside})];
  }
  const auto one_more = [](std::uint32_t entry) { return entry < shared::kFirstNode ? entry + 1 : 1; };
  std::uint32_t* row = &root_[entry_of({0, y, z})];
  for (int x = way > 0 ? 0 : size_.x - 1; x >= 0 && x < size_.x; x += way) {
    if (row[x] >= shared::kFirstNode) continue;
    if (x - way >= 0 && x - way < size_.x) row[x] = std::min(row[x], one_more(row[x - way]));
    for (std::size_t r = 0; r < rows_swept; ++r)
      for (int beside = std::max(x - 1, 0); beside <= std::min(x + 1, size_.x - 1); ++beside)
        row[x] = std::min(row[x], one_more(rows[r][beside]));
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
