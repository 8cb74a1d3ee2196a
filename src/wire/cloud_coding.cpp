#include "wire/cloud_coding.hpp"

#include <algorithm>
#include <numeric>

namespace brume::wire {
namespace {

using sim::BlockSet;
using sim::Cloud;
using sim::CloudParts;

enum Kind : std::size_t { kFill, kDetached, kSurvival };

// The voxels of `set` that are not in `other`.
BlockSet without(const BlockSet& set, const BlockSet& other) {
  std::vector<sim::VoxelBlock> blocks;
  for (sim::VoxelBlock block : set.blocks()) {
    if (const sim::VoxelBlock* taken = other.find_block(glm::ivec3(block.at))) block.mask &= ~taken->mask;
    if (block.mask != 0) blocks.push_back(block);
  }
  return BlockSet::from_blocks(std::move(blocks));
}

// The densities of voxels in an earlier cloud, without its dissolve.
std::vector<std::uint8_t> densities_of(const Cloud& before, std::uint32_t tick, const BlockSet& set) {
  const sim::CloudPhase phase = before.undissolved_phase(tick);
  std::vector<std::uint8_t> densities;
  set.for_each([&](glm::ivec3 voxel, std::uint32_t) { densities.push_back(before.density(voxel, phase)); });
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

// Ranks of a fill by distance from its source: the order in which smoke reaches new voxels.
std::vector<std::uint32_t> nearest_first(const BlockSet& fill, glm::ivec3 source) {
  std::vector<std::uint32_t> order;
  for (const sim::FilledVoxel& one : sim::flood_fill(fill, source)) order.push_back(fill.rank(one.voxel));
  return order;
}

// Ranks of detached voxels, farthest first where distances are known: the order in which smoke leaves.
std::vector<std::uint32_t> farthest_first(const BlockSet& detached, const Cloud* before) {
  std::vector<std::uint32_t> order(detached.size());
  std::iota(order.begin(), order.end(), 0u);
  if (!before) return order;
  std::vector<std::uint32_t> distances;
  detached.for_each([&](glm::ivec3 voxel, std::uint32_t) {
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
  if (order.size() != parts.fill.size()) return archive.fail("a flowing cloud is not connected");
  archive.delays(kFill, order, parts.fill_base, parts.fill_delay);
}

template <typename Coder>
void code_detached(Archive<Coder>& archive, const Cloud* before, std::uint32_t tick, CloudParts& parts) {
  std::vector<std::uint8_t> densities, survival;
  if (before) {
    densities = densities_of(*before, parts.flow_tick != 0 ? parts.flow_tick : tick, parts.detached);
    survival = survival_of(*before, parts.detached);
  }
  archive.densities(kDetached, parts.detached, densities, parts.detached_base);
  archive.densities(kSurvival, parts.detached, survival, parts.detached_survival);
  archive.delays(kDetached, farthest_first(parts.detached, before), parts.detached_base,
                 parts.detached_delay);
}

}  // namespace

template <typename Coder>
void code_cloud(Archive<Coder>& archive, const Cloud* before, std::uint32_t tick, CloudParts& parts) {
  // Where and when it started.
  serialize(archive, parts.origin);
  const glm::ivec3 source = parts.origin.source;
  if (parts.origin.detonation_tick > tick) archive.fail("a cloud exists before its detonation");
  if (glm::any(glm::lessThan(source, glm::ivec3(0))) ||
      glm::any(glm::greaterThanEqual(source, archive.layout().size)))
    archive.fail("a cloud's source lies outside of the grid");

  // Its voxels: what the earlier cloud had and is not in the fill is likely detached.
  Prediction like;
  BlockSet not_in_fill;
  if (before) like = {&before->voxels(), 0};
  archive.set(source, like, parts.fill);
  if (before) {
    not_in_fill = without(before->voxels(), parts.fill);
    like = {&not_in_fill, 1};
  }
  archive.set(source, like, parts.detached);

  // Its flow, and the smoke outside of the fill.
  if (archive.flag(Flag::flows, parts.flow_tick != 0)) {
    archive.context.at(Field::flow_tick) = tick;
    archive.field(Field::flow_tick, parts.flow_tick);
    if (parts.flow_tick > tick) archive.fail("a cloud's flow starts in the future");
    if (archive.ok()) code_fill_flow(archive, before, parts);
  }
  if (archive.ok()) code_detached(archive, before, tick, parts);
}

template void code_cloud(Archive<Encoder>&, const Cloud*, std::uint32_t, CloudParts&);
template void code_cloud(Archive<Decoder>&, const Cloud*, std::uint32_t, CloudParts&);

}  // namespace brume::wire
