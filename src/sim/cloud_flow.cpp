// How a cloud flows when the level around it changes.
#include <algorithm>
#include <bit>
#include <utility>

#include "sim/cloud.hpp"

namespace brume::sim {
namespace {

/// The free voxels of a cloud with their densities and distances before the edit, by rank.
struct Before {
  BlockSet set;
  std::vector<std::uint8_t> densities, survival;
  std::vector<std::uint32_t> distances;
};

Before capture(const Cloud& cloud, const voxel::BitGrid& grid, std::uint32_t tick) {
  Before before;
  const CloudPhase phase = cloud.undissolved_phase(tick);
  before.densities.reserve(cloud.voxels().size());
  before.survival.reserve(cloud.voxels().size());
  before.distances.reserve(cloud.voxels().size());
  before.set = filter(cloud.voxels(), [&](glm::ivec3 voxel, std::uint32_t rank) {
    if (!grid.free(voxel)) return false;
    before.densities.push_back(cloud.density(rank, phase));
    before.survival.push_back(cloud.survival()[rank]);
    before.distances.push_back(cloud.distances()[rank]);
    return true;
  });
  return before;
}

/// The old source, or the nearest smoke voxel to it that is still free.
glm::ivec3 source_in(const Before& before, glm::ivec3 old, const voxel::BitGrid& grid) {
  if (grid.free(old) || before.set.empty()) return old;
  const auto nearest = std::min_element(before.distances.begin(), before.distances.end());
  const auto rank = static_cast<std::uint32_t>(nearest - before.distances.begin());
  glm::ivec3 source = old;
  before.set.for_each([&](glm::ivec3 voxel, std::uint32_t at) {
    if (at == rank) source = voxel;
  });
  return source;
}

/// Smoke outside of the new fill, as ranks in Before.
struct Detached {
  std::vector<std::uint32_t> trapped;  // cut off from the source: stays
  std::vector<std::uint32_t> lost;     // leaves
};

/// 1 + the ticks after the edit at which each fill voxel starts to change to its new density; 0: at once.
/// Appends the ranks of the voxels gained to `gained`, nearest first.
std::vector<std::uint16_t> fill_delays(const CloudParts& p, const FillValues& fill, const Before& before,
                                       Front front, std::vector<std::uint32_t>& gained) {
  // Voxels that held smoke before change at once, if at all.
  const std::vector<std::uint32_t>& distances = fill.distances;
  std::vector<std::uint16_t> delays(p.fill.size());
  for_each_with(p.fill, before.set, [&](glm::ivec3, std::uint32_t rank, std::uint32_t old) {
    if (old == BlockSet::kNone)
      gained.push_back(rank);
    else
      delays[rank] =
          before.densities[old] == Cloud::profile(reach_of(distances[rank], fill.lag[rank]), front) ? 0 : 1;
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
  std::vector<std::uint16_t> delay_of(before.set.size(), 0);
  for (std::size_t i = 0; i < lost.size(); ++i)
    delay_of[lost[i]] =
        gained.empty() ? std::uint16_t{1} : parts.fill_delay[gained[i * gained.size() / lost.size()]];

  std::vector<bool> detaches(before.set.size(), false);
  for (const auto* list : {&detached.trapped, &lost})
    for (const std::uint32_t i : *list) detaches[i] = true;
  parts.detached = filter(before.set, [&](glm::ivec3, std::uint32_t i) {
    if (!detaches[i]) return false;
    parts.detached_base.push_back(before.densities[i]);
    parts.detached_delay.push_back(delay_of[i]);
    parts.detached_survival.push_back(before.survival[i]);
    return true;
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
  const BlockSet joined = connected_part(before.set, parts.origin.source);
  std::vector<std::uint32_t> cut_off;
  for_each_with(before.set, joined, [&](glm::ivec3, std::uint32_t i, std::uint32_t in_joined) {
    if (in_joined == BlockSet::kNone && before.densities[i] > 0) cut_off.push_back(i);
  });

  // The new fill: a flood with the remaining amount.
  const std::uint32_t whole = parts.origin.settings.voxels;
  Flood flood = flood_set(grid, parts.origin.source,
                          whole - std::min(whole, static_cast<std::uint32_t>(cut_off.size())));
  parts.fill = std::move(flood.voxels);
  Detached detached;
  auto next_cut_off = cut_off.begin();
  for_each_with(before.set, parts.fill, [&](glm::ivec3, std::uint32_t i, std::uint32_t in_fill) {
    const bool is_cut_off = next_cut_off != cut_off.end() && *next_cut_off == i;
    if (is_cut_off) ++next_cut_off;
    if (before.densities[i] > 0 && in_fill == BlockSet::kNone)
      (is_cut_off ? detached.trapped : detached.lost).push_back(i);
  });

  // The settled cloud with the new fill gives the target densities: which voxels change, and when.
  FillValues values = fill_values(parts.origin, parts.fill, std::move(flood.distances));
  std::vector<std::uint32_t> gained;
  const Front front =
      front_of(amount(tick), static_cast<std::uint32_t>(detached.trapped.size()), flood.counts);
  if (!parts.fill.empty()) parts.fill_delay = fill_delays(parts, values, before, front, gained);

  // The flow starts from the densities before the edit.
  parts.flow_tick = std::max(tick, 1u);
  parts.fill_base.reserve(parts.fill.size());
  for_each_with(parts.fill, before.set, [&](glm::ivec3, std::uint32_t, std::uint32_t old) {
    parts.fill_base.push_back(old == BlockSet::kNone ? std::uint8_t{0} : before.densities[old]);
  });
  set_detached(parts, before, std::move(detached), gained);

  Cloud flowing;
  flowing.parts_ = std::move(parts);
  flowing.finish(std::move(values), std::move(flood.counts));
  return flowing;
}

Cloud Cloud::settled() const {
  // Of the detached smoke only the trapped part remains.
  CloudParts parts;
  parts.origin = parts_.origin;
  parts.fill = parts_.fill;
  parts.detached = filter(parts_.detached, [&](glm::ivec3, std::uint32_t rank) {
    if (parts_.detached_delay[rank] != 0) return false;
    parts.detached_base.push_back(parts_.detached_base[rank]);
    parts.detached_delay.push_back(0);
    parts.detached_survival.push_back(parts_.detached_survival[rank]);
    return true;
  });

  // The flood is unchanged.
  std::vector<std::uint32_t> distances;
  distances.reserve(parts.fill.size());
  for_each_with(parts.fill, voxels(), [&](glm::ivec3, std::uint32_t, std::uint32_t rank) {
    distances.push_back(distances_[rank]);
  });
  Cloud cloud;
  cloud.parts_ = std::move(parts);
  cloud.finish(fill_values(cloud.parts_.origin, cloud.parts_.fill, std::move(distances)), distance_counts_);
  return cloud;
}

}  // namespace brume::sim
