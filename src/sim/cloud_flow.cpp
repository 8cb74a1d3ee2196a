// How a cloud goes on when the level around it changes.
#include <algorithm>
#include <bit>

#include "sim/cloud.hpp"

namespace brume::sim {
namespace {

/// Free voxels of a cloud with the densities and distances that they have now.
struct Before {
  std::vector<glm::ivec3> voxels;
  std::vector<std::uint8_t> densities, survival;
  std::vector<std::uint32_t> distances;
  BlockSet set;  // of the same voxels: a rank is the number in the lists
};

Before look_at(const Cloud& cloud, const voxel::BitGrid& grid, std::uint32_t tick) {
  Before before;
  const CloudPhase phase = cloud.undissolved_phase(tick);
  cloud.voxels().for_each([&](glm::ivec3 voxel, std::uint32_t rank) {
    if (!grid.free(voxel)) return;
    before.voxels.push_back(voxel);
    before.densities.push_back(cloud.density(rank, phase));
    before.survival.push_back(cloud.survival()[rank]);
    before.distances.push_back(cloud.distances()[rank]);
  });
  before.set = BlockSet(before.voxels);
  return before;  // the voxels came in the order of ranks, so that list and set agree
}

/// The old source, or the nearest voxel to it in the smoke that is still free.
glm::ivec3 source_in(const Before& before, glm::ivec3 old, const voxel::BitGrid& grid) {
  if (grid.free(old) || before.voxels.empty()) return old;
  const auto nearest = std::min_element(before.distances.begin(), before.distances.end());
  return before.voxels[static_cast<std::size_t>(nearest - before.distances.begin())];
}

std::vector<glm::ivec3> voxels_of(std::span<const FilledVoxel> filled) {
  std::vector<glm::ivec3> voxels;
  voxels.reserve(filled.size());
  for (const FilledVoxel& one : filled) voxels.push_back(one.voxel);
  return voxels;
}

/// Smoke outside of the new fill: where it was and when it begins to leave.
struct Rest {
  std::vector<std::uint32_t> trapped, lost;  // numbers in the lists of Before
};

/// Ticks after the edit, + 1, at which each fill voxel turns to its new density; those gained in `gained`, by
/// rank, nearest first.
std::vector<std::uint16_t> fill_delays(const Cloud& after, const Before& before, Front front,
                                       std::vector<std::uint32_t>& gained) {
  const CloudParts& p = after.parts();
  std::vector<std::uint16_t> delays(p.fill.size());
  std::vector<std::uint32_t> distances(p.fill.size());
  p.fill.for_each([&](glm::ivec3 voxel, std::uint32_t rank) {
    const std::uint32_t in_all = after.voxels().rank(voxel);
    distances[rank] = after.distances()[in_all];
    const std::uint32_t old = before.set.rank(voxel);
    if (old == BlockSet::kNone)
      gained.push_back(rank);
    else
      delays[rank] = before.densities[old] == Cloud::profile(after.reach(in_all), front) ? 0 : 1;
  });
  std::stable_sort(gained.begin(), gained.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return distances[a] < distances[b]; });
  const std::uint64_t farthest = *std::max_element(distances.begin(), distances.end());
  for (const std::uint32_t rank : gained) {
    const std::uint64_t way = distances[rank] - distances[gained.front()];
    const std::uint64_t ticks =
        way * 2 * p.origin.settings.bloom_ticks / std::max<std::uint64_t>(farthest, 1);
    delays[rank] = static_cast<std::uint16_t>(1 + std::min<std::uint64_t>(ticks, 65534));
  }
  return delays;
}

/// Enters the smoke outside of the fill: what is trapped stays, the i-th of those lost, farthest first,
/// leaves when the voxel gained that takes its smoke is due.
void settle(CloudParts& parts, const Before& before, Rest rest, std::span<const std::uint32_t> gained) {
  std::stable_sort(rest.lost.begin(), rest.lost.end(), [&](std::uint32_t a, std::uint32_t b) {
    return before.distances[a] > before.distances[b];
  });
  std::vector<std::uint16_t> delay_of(before.voxels.size(), 0);
  for (std::size_t i = 0; i < rest.lost.size(); ++i)
    delay_of[rest.lost[i]] =
        gained.empty() ? std::uint16_t{1} : parts.fill_delay[gained[i * gained.size() / rest.lost.size()]];

  std::vector<glm::ivec3> voxels;
  for (const auto* list : {&rest.trapped, &rest.lost})
    for (const std::uint32_t i : *list) voxels.push_back(before.voxels[i]);
  parts.detached = BlockSet(voxels);
  parts.detached.for_each([&](glm::ivec3 voxel, std::uint32_t) {
    const std::uint32_t i = before.set.rank(voxel);
    parts.detached_base.push_back(before.densities[i]);
    parts.detached_delay.push_back(delay_of[i]);
    parts.detached_survival.push_back(before.survival[i]);
  });
}

}  // namespace

bool Cloud::touched_by(std::span<const EditBlock> edits) const {
  for (const EditBlock& edit : edits) {
    const glm::ivec3 corner = glm::ivec3(edit.at) * kBlockSize;
    if (glm::any(glm::greaterThan(corner, high() + 1)) || glm::any(glm::lessThan(corner + kBlockSize, low())))
      continue;
    const VoxelBlock* own = voxels().find_block(glm::ivec3(edit.at));
    if (own && (own->mask & edit.make_solid) != 0) return true;
    for (std::uint64_t left = edit.make_free; left != 0; left &= left - 1) {
      const glm::ivec3 voxel = voxel_of_block(glm::ivec3(edit.at), std::countr_zero(left));
      for (int i = 0; i < 27; ++i)
        if (voxels().contains(voxel + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1)) return true;
    }
  }
  return false;
}

Cloud Cloud::flowed(const voxel::BitGrid& grid, std::uint32_t tick) const {
  const Before before = look_at(*this, grid, tick);
  CloudParts parts;
  parts.origin = parts_.origin;
  parts.origin.source = source_in(before, parts_.origin.source, grid);

  // What the smoke itself no longer joins to the source is trapped. It counts; the rest is found anew.
  const BlockSet joined(voxels_of(flood_fill(before.set, parts.origin.source)));
  std::uint32_t cut_off = 0;
  for (std::size_t i = 0; i < before.voxels.size(); ++i)
    if (before.densities[i] > 0 && !joined.contains(before.voxels[i])) ++cut_off;
  const std::uint32_t amount = parts.origin.settings.voxels;
  const auto filled = flood_fill(grid, parts.origin.source, amount - std::min(amount, cut_off));
  parts.fill = BlockSet(voxels_of(filled));
  Rest rest;
  for (std::uint32_t i = 0; i < before.voxels.size(); ++i)
    if (before.densities[i] > 0 && !parts.fill.contains(before.voxels[i]))
      (joined.contains(before.voxels[i]) ? rest.lost : rest.trapped).push_back(i);

  // The new fill as if nothing flowed tells which voxels have to change, and when.
  CloudParts settled = parts;
  settle(settled, before, {rest.trapped, {}}, {});
  Cloud after;
  after.parts_ = std::move(settled);
  after.finish(filled);
  std::vector<std::uint32_t> gained;
  if (!parts.fill.empty())
    parts.fill_delay = fill_delays(after, before, after.undissolved_phase(tick).front, gained);
  parts.flow_tick = std::max(tick, 1u);
  parts.fill.for_each([&](glm::ivec3 voxel, std::uint32_t) {
    const std::uint32_t old = before.set.rank(voxel);
    parts.fill_base.push_back(old == BlockSet::kNone ? std::uint8_t{0} : before.densities[old]);
  });
  settle(parts, before, rest, gained);

  Cloud flowing;
  flowing.parts_ = std::move(parts);
  flowing.finish(filled);
  return flowing;
}

Cloud Cloud::settled() const {
  CloudParts parts;
  parts.origin = parts_.origin;
  parts.fill = parts_.fill;
  std::vector<glm::ivec3> trapped;
  parts_.detached.for_each([&](glm::ivec3 voxel, std::uint32_t rank) {
    if (parts_.detached_delay[rank] != 0) return;
    trapped.push_back(voxel);
    parts.detached_base.push_back(parts_.detached_base[rank]);
    parts.detached_delay.push_back(0);
    parts.detached_survival.push_back(parts_.detached_survival[rank]);
  });
  parts.detached = BlockSet(trapped);  // the order of ranks is kept

  std::vector<FilledVoxel> filled;
  parts.fill.for_each([&](glm::ivec3 voxel, std::uint32_t) {
    filled.push_back({voxel, distances_[voxels().rank(voxel)]});
  });
  std::stable_sort(filled.begin(), filled.end(),
                   [](const FilledVoxel& a, const FilledVoxel& b) { return a.distance < b.distance; });
  Cloud cloud;
  cloud.parts_ = std::move(parts);
  cloud.finish(filled);
  return cloud;
}

}  // namespace brume::sim
