#include "sim/state_filter.hpp"

#include <algorithm>
#include <bit>
#include <tuple>
#include <vector>

#include "sim/walk.hpp"

namespace brume::sim {
namespace {

bool meets(const VoxelBlock& block, const Box<int>& box) {
  const glm::ivec3 low = glm::ivec3(block.at) * kBlockSize;
  const Box<int> all{low, low + kBlockSize};
  if (intersection(all, box).empty()) return false;
  if (box.contains(all)) return true;
  for (std::uint64_t bits = block.mask; bits != 0; bits &= bits - 1)
    if (box.contains(voxel_of_block(glm::ivec3(block.at), std::countr_zero(bits)))) return true;
  return false;
}

/// Whether a voxel of the set is in the box. Visits rows of blocks in it, or all where those are fewer.
bool meets(const BlockSet& set, const Box<int>& box) {
  const Box<int> common = intersection({set.low(), set.high() + 1}, box);
  if (set.empty() || common.empty()) return false;
  const glm::ivec3 low = common.low >> 2, high = (common.high - 1) >> 2;
  const std::span<const VoxelBlock> blocks = set.blocks();
  if (std::int64_t{high.z - low.z + 1} * (high.y - low.y + 1) > std::ssize(blocks))
    return std::ranges::any_of(blocks, [&](const VoxelBlock& block) { return meets(block, box); });
  const auto key = [](glm::ivec3 at) { return std::tuple(at.z, at.y, at.x); };
  auto block = blocks.begin();
  for (int z = low.z; z <= high.z; ++z)
    for (int y = low.y; y <= high.y; ++y) {
      block = std::ranges::lower_bound(block, blocks.end(), key({low.x, y, z}), {},
                                       [&](const VoxelBlock& one) { return key(glm::ivec3(one.at)); });
      for (; block != blocks.end() && key(glm::ivec3(block->at)) <= key({high.x, y, z}); ++block)
        if (meets(*block, box)) return true;
    }
  return false;
}

/// Whether items of a state reach a box of voxels.
class Reach {
 public:
  Reach(const State& state, const Box<int>& box)
      : ruler_(state.layout), tick_(state.tick), box_{box.low - kFilterReach, box.high + kFilterReach} {}

  bool operator()(const LiveCloud& live) const { return meets(live.cloud->voxels(), box_); }
  template <typename Field>
  bool operator()(const Live<Field>& live) const {
    return meets(live.field->reached(), box_);
  }
  bool operator()(const Flight& flight) const {
    // States that were received may have grenades that should have detonated.
    const auto all = static_cast<std::int64_t>(flight.detonation_tick - flight.throw_tick),
               passed = std::min(static_cast<std::int64_t>(tick_ - flight.throw_tick), all);
    const glm::i64vec3 from(flight.from), path = glm::i64vec3(ruler_.centre(flight.landing)) - from;
    return has(Position(from + path * passed / all));
  }
  bool operator()(const Body& body) const { return has(body.position) || has(body.previous); }
  bool operator()(const BulletHole& hole) const;

 private:
  bool has(Position position) const {
    return box_.contains(glm::ivec3(ruler_.subvoxel(position) >> std::int64_t{10}));
  }

  VoxelRuler ruler_;
  std::uint32_t tick_;
  Box<int> box_;
};

/// Whether the bore's axis meets the box, made larger by two radii: more than shared::kHoleWidest, the
/// farthest that a hole reaches from its axis. In doubles, which a server alone decides by, and whose sums,
/// products, quotients and roots are the same everywhere.
bool Reach::operator()(const BulletHole& hole) const {
  constexpr double kVoxel = 1024;
  const glm::dvec3 from(ruler_.subvoxel(hole.shot.origin));
  const glm::dvec3 direction = glm::normalize(glm::dvec3(hole.shot.toward - hole.shot.origin));
  const auto wide = static_cast<double>(ruler_.subvoxels(2 * std::int64_t{hole.shot.radius}) + 1);
  double begin = 0, end = static_cast<double>(ruler_.subvoxels(static_cast<std::int64_t>(hole.distance)) + 1);
  for (int axis = 0; axis < 3; ++axis) {
    const double low = kVoxel * box_.low[axis] - wide - from[axis],
                 high = kVoxel * box_.high[axis] + wide - from[axis];
    if (direction[axis] == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    const double a = low / direction[axis], b = high / direction[axis];
    begin = std::max(begin, std::min(a, b));
    end = std::min(end, std::max(a, b));
  }
  return begin <= end;
}

}  // namespace

State filtered(const State& state, std::span<const Box<int>> boxes) {
  std::vector<Reach> reaches_box;
  for (const Box<int>& box : boxes)
    if (!box.empty()) reaches_box.emplace_back(state, box);
  State part = state;
  for_each_state_list([&](const char*, auto list) {
    std::erase_if(part.*list, [&](const auto& item) {
      return std::ranges::none_of(reaches_box, [&](const Reach& reaches) { return reaches(item); });
    });
  });
  return part;
}

}  // namespace brume::sim
