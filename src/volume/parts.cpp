#include "volume/parts.hpp"

#include <algorithm>
#include <array>

#include "core/box.hpp"

namespace brume::volume {
namespace {

/// How far a plane is from an even division, in bricks.
std::uint64_t distance(std::uint64_t a, std::uint64_t b) {
  return a > b ? a - b : b - a;
}

}  // namespace

Result<Parts> Parts::divide(const SparseVolume& volume, std::uint32_t count) {
  std::vector<glm::ivec3> bricks;
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot)
    if (volume.in_use(slot)) bricks.push_back(volume.brick_of(slot));
  Parts parts;
  parts.count_ = count;
  parts.nodes_.push_back({0, 0, 0, count});
  if (count == 0 || bricks.size() < count || !parts.split(0, bricks))
    return Failure{ErrorCode::usage, "a volume of " + std::to_string(bricks.size()) +
                                         " bricks cannot be divided into " + std::to_string(count) +
                                         " parts; use fewer processes"};
  return parts;
}

/// Divides the bricks of a node by the plane that is nearest to an even division, along the longest axis that
/// has one.
bool Parts::split(std::uint32_t number, std::span<glm::ivec3> bricks) {
  const Node node = nodes_[number];
  if (node.count == 1) return !bricks.empty();
  // Longest axes first: cuts across them make the most compact parts.
  Box<int> box{bricks.front(), bricks.front() + 1};
  for (const glm::ivec3 brick : bricks) box = united(box, {brick, brick + 1});
  const glm::ivec3 size = box.high - box.low;
  std::array<int, 3> axes{0, 1, 2};
  std::stable_sort(axes.begin(), axes.end(), [&](int a, int b) { return size[a] > size[b]; });

  const std::uint32_t left = node.count / 2, right = node.count - left;
  const std::uint64_t wanted = bricks.size() * left / node.count;
  for (const int axis : axes) {
    // The plane with the most even numbers of bricks that leaves enough for each side.
    std::vector<std::uint64_t> layers(static_cast<std::size_t>(size[axis]));
    for (const glm::ivec3 brick : bricks) ++layers[static_cast<std::size_t>(brick[axis] - box.low[axis])];
    std::uint64_t below = 0, best_below = 0;
    int best = box.low[axis];
    for (int plane = box.low[axis] + 1; plane < box.high[axis]; ++plane) {
      below += layers[static_cast<std::size_t>(plane - 1 - box.low[axis])];
      if (below < left || bricks.size() - below < right) continue;
      if (best > box.low[axis] && distance(below, wanted) >= distance(best_below, wanted)) continue;
      best = plane;
      best_below = below;
    }
    if (best == box.low[axis]) continue;
    // Divide there. Where a side cannot be divided on, undo it and try the next axis.
    const auto middle =
        std::partition(bricks.begin(), bricks.end(), [&](glm::ivec3 brick) { return brick[axis] < best; });
    const auto count_below = static_cast<std::size_t>(middle - bricks.begin());
    const auto first_child = static_cast<std::uint32_t>(nodes_.size());
    nodes_[number] = {axis, best, node.first, node.count, first_child, first_child + 1};
    nodes_.push_back({0, 0, node.first, left});
    nodes_.push_back({0, 0, node.first + left, right});
    if (split(first_child, bricks.first(count_below)) && split(first_child + 1, bricks.subspan(count_below)))
      return true;
    nodes_.resize(first_child);
  }
  return false;
}

std::uint32_t Parts::part_of(glm::ivec3 brick) const {
  std::uint32_t node = 0;
  while (nodes_[node].count > 1)
    node = brick[nodes_[node].axis] < nodes_[node].plane ? nodes_[node].left : nodes_[node].right;
  return nodes_[node].first;
}

std::vector<std::uint32_t> Parts::order_from(glm::vec3 eye) const {
  std::vector<std::uint32_t> order, open{0};
  while (!open.empty()) {
    const Node& node = nodes_[open.back()];
    open.pop_back();
    if (node.count == 1) {
      order.push_back(node.first);
      continue;
    }
    const bool is_below = eye[node.axis] < static_cast<float>(node.plane * shared::kBrickVoxels);
    open.push_back(is_below ? node.right : node.left);
    open.push_back(is_below ? node.left : node.right);
  }
  return order;
}

SparseVolume part_of_volume(const SparseVolume& whole, const Parts& parts, std::uint32_t part) {
  SparseVolumeInfo info;
  info.origin_world = whole.layout().origin_world;
  info.voxel_size = whole.layout().voxel_size;
  for (std::uint32_t i = 0; i < whole.channel_count(); ++i)
    info.channels.push_back(whole.format(ChannelId{i}));
  SparseVolume volume(info);
  volume.begin_update();
  for (std::uint32_t slot = 0; slot < whole.slot_count(); ++slot) {
    if (!whole.in_use(slot) || parts.part_of(whole.brick_of(slot)) != part) continue;
    const std::uint32_t own = volume.acquire(whole.brick_of(slot));
    for (std::uint32_t i = 0; i < whole.channel_count(); ++i)
      std::ranges::copy(whole.channel(ChannelId{i}, slot), volume.channel(ChannelId{i}, own).begin());
  }
  for (const UniformBrick& brick : whole.uniform_bricks())
    if (parts.part_of(brick.at) == part) volume.set_uniform(brick.at, brick.texel);
  volume.set_extent(whole);
  volume.end_update();
  return volume;
}

}  // namespace brume::volume
