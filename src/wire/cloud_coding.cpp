#include "wire/cloud_coding.hpp"

#include <algorithm>
#include <numeric>

namespace brume::wire {
namespace {

using sim::BlockSet;
using sim::Cloud;
using sim::CloudParts;

enum Kind : std::size_t { kFill, kRest, kSurvival };

// The voxels of one set that are not in another.
BlockSet without(const BlockSet& set, const BlockSet& other) {
  std::vector<sim::VoxelBlock> blocks;
  for (sim::VoxelBlock block : set.blocks()) {
    if (const sim::VoxelBlock* taken = other.find_block(glm::ivec3(block.at))) block.mask &= ~taken->mask;
    if (block.mask != 0) blocks.push_back(block);
  }
  return BlockSet::from_blocks(std::move(blocks));
}

// The densities that voxels had before, or how long their smoke withstands.
std::vector<std::uint8_t> densities_of(const Cloud& before, std::uint32_t tick, const BlockSet& set) {
  const sim::CloudPhase moment = before.undissolved_phase(tick);
  std::vector<std::uint8_t> densities;
  set.for_each([&](glm::ivec3 voxel, std::uint32_t) { densities.push_back(before.density(voxel, moment)); });
  return densities;
}

std::vector<std::uint8_t> survival_of(const Cloud& before, const BlockSet& set) {
  std::vector<std::uint8_t> survival;
  set.for_each([&](glm::ivec3 voxel, std::uint32_t) {
    const std::uint32_t rank = before.voxels().rank(voxel);
    survival.push_back(rank == BlockSet::kNone ? std::uint8_t{0} : before.survival()[rank]);
  });
  return survival;
}

// Ranks of a fill, nearest to its source first: the order in which new voxels are reached.
std::vector<std::uint32_t> nearest_first(const BlockSet& fill, glm::ivec3 source) {
  std::vector<std::uint32_t> order;
  for (const sim::FilledVoxel& one : sim::flood_fill(fill, source)) order.push_back(fill.rank(one.voxel));
  return order;
}

// Ranks of the rest, farthest first where the distances are known: the order in which smoke leaves.
std::vector<std::uint32_t> farthest_first(const BlockSet& rest, const Cloud* before) {
  std::vector<std::uint32_t> order(rest.size());
  std::iota(order.begin(), order.end(), 0u);
  if (!before) return order;
  std::vector<std::uint32_t> distances;
  rest.for_each([&](glm::ivec3 voxel, std::uint32_t) {
    const std::uint32_t rank = before->voxels().rank(voxel);
    distances.push_back(rank == BlockSet::kNone ? 0 : before->distances()[rank]);
  });
  std::stable_sort(order.begin(), order.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return distances[a] > distances[b]; });
  return order;
}

template <typename Coder>
void code_fill_flow(Archive<Coder>& archive, const Cloud* before, CloudParts& parts) {
  std::vector<std::uint8_t> expected;
  if (before) expected = densities_of(*before, parts.flow_tick, parts.fill);
  archive.densities(kFill, parts.fill, expected, parts.fill_base);
  const std::vector<std::uint32_t> order = nearest_first(parts.fill, parts.origin.source);
  if (order.size() != parts.fill.size()) return archive.refuse("a cloud that is not connected flows on");
  archive.delays(kFill, order, parts.fill_base, parts.fill_delay);
}

template <typename Coder>
void code_rest(Archive<Coder>& archive, const Cloud* before, std::uint32_t tick, CloudParts& parts) {
  std::vector<std::uint8_t> densities, survival;
  if (before) {
    densities = densities_of(*before, parts.flow_tick != 0 ? parts.flow_tick : tick, parts.detached);
    survival = survival_of(*before, parts.detached);
  }
  archive.densities(kRest, parts.detached, densities, parts.detached_base);
  archive.densities(kSurvival, parts.detached, survival, parts.detached_survival);
  archive.delays(kRest, farthest_first(parts.detached, before), parts.detached_base, parts.detached_delay);
}

}  // namespace

template <typename Coder>
void code_cloud(Archive<Coder>& archive, const Cloud* before, std::uint32_t tick, CloudParts& parts) {
  serialize(archive, parts.origin);
  const glm::ivec3 source = parts.origin.source;
  if (parts.origin.detonation_tick > tick) archive.refuse("a cloud is there before it begins");
  if (glm::any(glm::lessThan(source, glm::ivec3(0))) ||
      glm::any(glm::greaterThanEqual(source, archive.layout().size)))
    archive.refuse("a cloud comes from outside of the grid");

  Prediction like;
  BlockSet left;
  if (before) like = {&before->voxels(), 0};
  archive.set(source, like, parts.fill);
  if (before) {
    left = without(before->voxels(), parts.fill);
    like = {&left, 1};
  }
  archive.set(source, like, parts.detached);

  if (archive.flag(Flag::flows, parts.flow_tick != 0)) {
    archive.memory.at(Field::flow_tick) = tick;
    archive.field(Field::flow_tick, parts.flow_tick);
    if (parts.flow_tick > tick) archive.refuse("a cloud flows before it begins to");
    if (archive.ok()) code_fill_flow(archive, before, parts);
  }
  if (archive.ok()) code_rest(archive, before, tick, parts);
}

template void code_cloud(Archive<Encoder>&, const Cloud*, std::uint32_t, CloudParts&);
template void code_cloud(Archive<Decoder>&, const Cloud*, std::uint32_t, CloudParts&);

}  // namespace brume::wire
