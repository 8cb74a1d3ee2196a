#include "smoke/cloud_growth.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <glm/gtc/packing.hpp>

#include "core/box.hpp"
#include "smoke/growth.hpp"

namespace brume::smoke {
namespace {

/// The bricks that a cloud's voxels are in or beside, in order.
std::vector<glm::ivec3> bricks_of(const sim::Cloud& cloud) {
  std::vector<glm::ivec3> bricks;
  for (const sim::VoxelBlock& block : cloud.voxels().blocks()) {
    const glm::ivec3 low = sim::kBlockSize * glm::ivec3(block.at);
    const glm::ivec3 first = (low - 1) >> 3, last = (low + sim::kBlockSize) >> 3;
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) bricks.push_back({x, y, z});
  }
  const auto before = [](glm::ivec3 a, glm::ivec3 b) {
    return a.z != b.z ? a.z < b.z : a.y != b.y ? a.y < b.y : a.x < b.x;
  };
  std::sort(bricks.begin(), bricks.end(), before);
  bricks.erase(std::unique(bricks.begin(), bricks.end()), bricks.end());
  return bricks;
}

/// The growth of the cloud's voxels in and around a brick: a box of 13^3 voxels whose first is brick 8 - 2.
class GrowthAround {
 public:
  static constexpr int kEdge = 13;

  GrowthAround(const sim::Cloud& cloud, std::span<const glm::vec3> growth, glm::ivec3 brick) {
    const glm::ivec3 low = shared::kBrickVoxels * brick - 2;
    const glm::ivec3 first = low >> 2, last = (low + kEdge - 1) >> 2;
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x)
          if (const sim::VoxelBlock* block = cloud.voxels().find_block({x, y, z})) add(*block, growth, low);
  }
  /// The mean over the 3^3 voxels around one, in w how many of them the cloud fills.
  glm::vec4 mean(glm::ivec3 local) const {
    glm::vec4 sum(0);
    for (int i = 0; i < 27; ++i) {
      const glm::ivec3 at = local + glm::ivec3(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
      sum += voxels_[static_cast<std::size_t>(at.x + kEdge * (at.y + kEdge * at.z))];
    }
    return {glm::vec3(sum) / std::max(sum.w, 1.0f), sum.w};
  }

 private:
  void add(const sim::VoxelBlock& block, std::span<const glm::vec3> growth, glm::ivec3 low) {
    std::uint32_t rank = block.first;
    for (std::uint64_t left = block.mask; left != 0; left &= left - 1, ++rank) {
      const glm::ivec3 at = sim::voxel_of_block(glm::ivec3(block.at), std::countr_zero(left)) - low;
      if (glm::any(glm::lessThan(at, glm::ivec3(0))) ||
          glm::any(glm::greaterThanEqual(at, glm::ivec3(kEdge))))
        continue;
      voxels_[static_cast<std::size_t>(at.x + kEdge * (at.y + kEdge * at.z))] = glm::vec4(growth[rank], 1);
    }
  }

  std::array<glm::vec4, kEdge * kEdge * kEdge> voxels_{};
};

}  // namespace

bool CloudGrowth::update(const sim::State& state, const SmokeBricks& volume) {
  const auto same = [](const std::shared_ptr<const sim::Cloud>& held, const sim::LiveCloud& live) {
    return held == live.cloud;
  };
  // Nothing to do while volume and clouds are the same.
  const std::uint64_t id = volume.id();
  if (volume_ == id && generation_ == volume.structure_generation() &&
      std::equal(clouds_.begin(), clouds_.end(), state.clouds.begin(), state.clouds.end(), same))
    return false;
  volume_ = id;
  generation_ = volume.structure_generation();

  // Keep the parts of clouds that are still there; find the new ones.
  std::map<const sim::Cloud*, std::vector<BrickPart>> before;
  before.swap(parts_of_cloud_);
  std::vector<std::shared_ptr<const sim::Cloud>> clouds;
  std::vector<const sim::Cloud*> fresh;
  for (const sim::LiveCloud& live : state.clouds) {
    clouds.push_back(live.cloud);
    if (!touches(volume, *live.cloud)) continue;
    if (auto held = before.extract(live.cloud.get()))
      parts_of_cloud_.insert(std::move(held));
    else
      fresh.push_back(live.cloud.get());
  }
  // Free the parts of clouds that are gone before new ones take parts.
  for (const auto& [cloud, brick_parts] : before)
    for (const BrickPart& brick_part : brick_parts) free_parts_.push_back(brick_part.part);
  for (const sim::Cloud* cloud : fresh)
    if (!parts_of_cloud_.contains(cloud))
      parts_of_cloud_.emplace(cloud, make_parts(*cloud, volume.layout().voxel_size));
  clouds_ = std::move(clouds);
  list_parts(volume);
  return true;
}

std::uint32_t CloudGrowth::allocate_part() {
  if (free_parts_.empty()) {
    displacements_.resize(displacements_.size() + shared::kDisplacementsPerBrick);
    return static_cast<std::uint32_t>(displacements_.size() / shared::kDisplacementsPerBrick - 1);
  }
  const std::uint32_t part = free_parts_.back();
  free_parts_.pop_back();
  return part;
}

std::vector<CloudGrowth::BrickPart> CloudGrowth::make_parts(const sim::Cloud& cloud, float voxel_size) {
  const std::vector<glm::vec3> growth = growth_of(cloud);
  float longest = 1;
  for (const glm::vec3& one : growth) longest = std::max(longest, glm::length(one));
  std::vector<BrickPart> brick_parts;
  for (const glm::ivec3 brick : bricks_of(cloud)) {
    const GrowthAround around(cloud, growth, brick);
    const std::uint32_t part = allocate_part();
    brick_parts.push_back({brick, part});
    new_parts_.push_back(part);
    glm::uvec2* out = displacements_.data() + std::size_t{part} * shared::kDisplacementsPerBrick;
    for (std::uint32_t i = 0; i < shared::kDisplacementsPerBrick; ++i) {
      const auto n = static_cast<int>(i);
      const glm::ivec3 point(n % shared::kDisplacementPoints,
                             n / shared::kDisplacementPoints % shared::kDisplacementPoints,
                             n / (shared::kDisplacementPoints * shared::kDisplacementPoints));
      const glm::vec4 mean = around.mean(2 * point + 1);
      // Where clouds meet, each counts for more the nearer its source is.
      const float near = 1.02f - std::min(glm::length(glm::vec3(mean)) / longest, 1.0f);
      const glm::vec3 metres = glm::vec3(mean) * voxel_size;
      *out++ = {glm::packHalf2x16({metres.x, metres.y}), glm::packHalf2x16({metres.z, mean.w / 27 * near})};
    }
  }
  return brick_parts;
}

/// Whether a brick that a cloud's voxels are in or beside has a slot. Of coarse bricks none counts.
bool CloudGrowth::touches(const SmokeBricks& volume, const sim::Cloud& cloud) {
  if (volume.level() > 0 || cloud.voxels().empty()) return false;
  bool any = false;
  for_each_in(Box<int>{(cloud.low() - 1) >> 3, ((cloud.high() + 1) >> 3) + 1},
              [&](glm::ivec3 brick) { any |= volume.slot_at(brick) != SmokeBricks::kNoSlot; });
  return any;
}

/// Which parts are in which slot.
void CloudGrowth::list_parts(const SmokeBricks& volume) {
  const std::uint32_t slots = volume.slot_count();
  std::vector<std::vector<glm::uvec2>> by_slot(slots);
  for (std::uint32_t i = 0; i < clouds_.size(); ++i) {
    const auto brick_parts = parts_of_cloud_.find(clouds_[i].get());
    if (brick_parts == parts_of_cloud_.end()) continue;
    for (const BrickPart& brick_part : brick_parts->second)
      if (const std::uint32_t slot = volume.slot_at(brick_part.brick); slot != SmokeBricks::kNoSlot)
        by_slot[slot].push_back({brick_part.part, i});
  }
  parts_.assign(slots, glm::uvec2(0));
  for (std::uint32_t slot = 0; slot < slots; ++slot) {
    parts_[slot] = {parts_.size() - slots, by_slot[slot].size()};
    parts_.insert(parts_.end(), by_slot[slot].begin(), by_slot[slot].end());
  }
}

}  // namespace brume::smoke
