// How a cloud flows when the level around it changes.
#include <algorithm>
#include <bit>

#include "sim/cloud.hpp"

namespace brume::sim {
namespace {

/// The free voxels of a cloud with their densities and distances before the edit.
struct Before {
  std::vector<glm::ivec3> voxels;
  std::vector<std::uint8_t> densities, survival;
  std::vector<std::uint32_t> distances;
  BlockSet set;  // the same voxels: a rank is an index into the lists
};

Before capture(const Cloud& cloud, const voxel::BitGrid& grid, std::uint32_t tick) {
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
  return before;  // voxels were visited in rank order, so list and set agree
}

/// The old source, or the nearest smoke voxel to it that is still free.
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

/// Smoke outside of the new fill, as indices into the lists of Before.
struct Detached {
  std::vector<std::uint32_t> trapped;  // cut off from the source: stays
  std::vector<std::uint32_t> lost;     // leaves
};

/// 1 + the ticks after the edit at which each fill voxel starts to change to its new density; 0: at once.
/// Appends the ranks of the voxels gained to `gained`, nearest first.
std::vector<std::uint16_t> fill_delays(const Cloud& after, const Before& before, Front front,
                                       std::vector<std::uint32_t>& gained) {
  // Voxels that held smoke before change at once, if at all.
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

  // The others follow by distance, at half the mean speed of the bloom.
  std::stable_sort(gained.begin(), gained.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return distances[a] < distances[b]; });
  const std::uint64_t farthest = *std::max_element(distances.begin(), distances.end());
  for (const std::uint32_t rank : gained) {
    const std::uint64_t distance = distances[rank] - distances[gained.front()];
    const std::uint64_t ticks =
        distance * 2 * p.origin.settings.bloom_ticks / std::max<std::uint64_t>(farthest, 1);
    delays[rank] = static_cast<std::uint16_t>(1 + std::min<std::uint64_t>(ticks, 65534));
  }
  return delays;
}

/// Fills the detached lists: trapped smoke stays; the i-th lost voxel, farthest first, empties when the
/// gained voxel that receives its smoke is due.
void set_detached(CloudParts& parts, const Before& before, Detached detached,
                  std::span<const std::uint32_t> gained) {
  std::vector<std::uint32_t>& lost = detached.lost;
  std::stable_sort(lost.begin(), lost.end(), [&](std::uint32_t a, std::uint32_t b) {
    return before.distances[a] > before.distances[b];
  });
  std::vector<std::uint16_t> delay_of(before.voxels.size(), 0);
  for (std::size_t i = 0; i < lost.size(); ++i)
    delay_of[lost[i]] =
        gained.empty() ? std::uint16_t{1} : parts.fill_delay[gained[i * gained.size() / lost.size()]];

  std::vector<glm::ivec3> voxels;
  for (const auto* list : {&detached.trapped, &lost})
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
    for (std::uint64_t bits = edit.make_free; bits != 0; bits &= bits - 1) {
      const glm::ivec3 voxel = voxel_of_block(glm::ivec3(edit.at), std::countr_zero(bits));
      for (int i = 0; i < 27; ++i)
        if (voxels().contains(voxel + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1)) return true;
    }
  }
  return false;
}

Cloud Cloud::flowed(const voxel::BitGrid& grid, std::uint32_t tick) const {
  const Before before = capture(*this, grid, tick);
  CloudParts parts;
  parts.origin = parts_.origin;
  parts.origin.source = source_in(before, parts_.origin.source, grid);

  // Smoke no longer connected to the source through smoke is trapped and counts against the amount.
  const BlockSet joined(voxels_of(flood_fill(before.set, parts.origin.source)));
  std::uint32_t cut_off = 0;
  for (std::size_t i = 0; i < before.voxels.size(); ++i)
    if (before.densities[i] > 0 && !joined.contains(before.voxels[i])) ++cut_off;

  // The new fill: a flood with the remaining amount.
  const std::uint32_t amount = parts.origin.settings.voxels;
  const auto filled = flood_fill(grid, parts.origin.source, amount - std::min(amount, cut_off));
  parts.fill = BlockSet(voxels_of(filled));
  Detached detached;
  for (std::uint32_t i = 0; i < before.voxels.size(); ++i)
    if (before.densities[i] > 0 && !parts.fill.contains(before.voxels[i]))
      (joined.contains(before.voxels[i]) ? detached.lost : detached.trapped).push_back(i);

  // A settled cloud with the new fill gives the target densities: which voxels change, and when.
  CloudParts settled = parts;
  set_detached(settled, before, {detached.trapped, {}}, {});
  Cloud after;
  after.parts_ = std::move(settled);
  after.finish(filled);
  std::vector<std::uint32_t> gained;
  if (!parts.fill.empty())
    parts.fill_delay = fill_delays(after, before, after.undissolved_phase(tick).front, gained);

  // The flow starts from the densities before the edit.
  parts.flow_tick = std::max(tick, 1u);
  parts.fill.for_each([&](glm::ivec3 voxel, std::uint32_t) {
    const std::uint32_t old = before.set.rank(voxel);
    parts.fill_base.push_back(old == BlockSet::kNone ? std::uint8_t{0} : before.densities[old]);
  });
  set_detached(parts, before, detached, gained);

  Cloud flowing;
  flowing.parts_ = std::move(parts);
  flowing.finish(filled);
  return flowing;
}

Cloud Cloud::settled() const {
  // Of the detached smoke only the trapped part remains.
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
  parts.detached = BlockSet(trapped);  // preserves the order of ranks

  // The flood is unchanged: sort its voxels by the known distances.
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
