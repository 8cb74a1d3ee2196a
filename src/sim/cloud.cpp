#include "sim/cloud.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <string>
#include <utility>

#include "core/error.hpp"
#include "core/hash.hpp"
#include "sim/fill_values.hpp"
#include "sim/fixed_point.hpp"

namespace brume::sim {
namespace {

constexpr int kAmountBits = 20;
/// Fraction of the dissolve that one voxel takes to fade.
constexpr std::uint32_t kDissolveSoft = kWhole * 6 / 10;
/// Fraction at which the voxel that withstands longest starts to fade.
constexpr std::uint32_t kDissolveLast = kWhole - kDissolveSoft;

Failure bad_parts(const std::string& expected) {
  return {ErrorCode::bad_input, "cloud: expected " + expected};
}

/// The checks that need no derived data.
Result<void> check_parts(const CloudParts& p) {
  const SmokeSettings& s = p.origin.settings;
  if (s.voxels < 1 || s.voxels > kMaxFillVoxels || s.bloom_ticks < 1 || s.bloom_ticks > kMaxTick ||
      s.hold_ticks > kMaxTick || s.dissolve_ticks < 1 || s.dissolve_ticks > kMaxTick)
    return bad_parts("smoke settings within their ranges");
  if (p.origin.detonation_tick > kMaxTick + kMaxTick / 8)
    return bad_parts("a detonation tick that an event can cause");
  for (const BlockSet* set : {&p.fill, &p.detached})
    if (!set->empty() && (glm::any(glm::lessThan(set->low(), glm::ivec3(0))) ||
                          glm::any(glm::greaterThanEqual(set->high(), glm::ivec3(voxel::kMaxAxis)))))
      return bad_parts("voxels within a grid");
  if (p.fill.size() > s.voxels) return bad_parts("no more voxels than its amount");
  if (count_common(p.fill, p.detached) != 0) return bad_parts("each voxel only once");
  const std::size_t flowing = p.flow_tick == 0 ? 0 : p.fill.size();
  if (p.fill_base.size() != flowing || p.fill_delay.size() != flowing ||
      p.detached_base.size() != p.detached.size() || p.detached_delay.size() != p.detached.size() ||
      p.detached_survival.size() != p.detached.size())
    return bad_parts("one value for each flowing voxel");
  const auto any_leaving = [&] {
    return std::any_of(p.detached_delay.begin(), p.detached_delay.end(), [](auto d) { return d != 0; });
  };
  if (p.flow_tick == 0 && any_leaving()) return bad_parts("no smoke to leave a settled cloud");
  return {};
}

// How a cloud flows when the level around it changes.

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

Cloud::Cloud(const voxel::BitGrid& grid, const CloudOrigin& origin) {
  BRUME_ASSERT(origin.settings.voxels >= 1 && origin.settings.voxels <= kMaxFillVoxels,
               std::to_string(origin.settings.voxels));
  BRUME_ASSERT(origin.settings.bloom_ticks >= 1 && origin.settings.dissolve_ticks >= 1, "a life of no ticks");
  parts_.origin = origin;
  Flood flood = flood_set(grid, origin.source, origin.settings.voxels);
  parts_.fill = std::move(flood.voxels);
  finish(fill_values(origin.source, origin.detonation_tick, parts_.fill, std::move(flood.distances)),
         std::move(flood.counts));
}

Result<Cloud> Cloud::from_parts(CloudParts parts) {
  if (auto ok = check_parts(parts); !ok) return ok.failure();
  Flood flood = flood_set(parts.fill, parts.origin.source);
  if (flood.voxels.size() != parts.fill.size())
    return bad_parts("all of its fill to be reachable from its source");
  Cloud cloud;
  cloud.parts_ = std::move(parts);
  cloud.finish(fill_values(cloud.origin().source, cloud.origin().detonation_tick, cloud.parts_.fill,
                           std::move(flood.distances)),
               std::move(flood.counts));
  return cloud;
}

/// Computes all derived data from the parts and from the flood that filled them.
void Cloud::finish(FillValues fill, std::vector<Flood::Count> counts) {
  const CloudParts& p = parts_;
  if (!p.detached.empty()) all_voxels_ = unite(p.fill, p.detached);
  distance_counts_ = std::move(counts);
  distance_counts_.shrink_to_fit();

  // Distance, survival and lag, moved from ranks in the fill to ranks in voxels().
  if (p.detached.empty() && p.flow_tick == 0) {
    distances_ = std::move(fill.distances);
    lag_ = std::move(fill.lag);
    survival_ = std::move(fill.survival);
  } else {
    const BlockSet& all = voxels();
    distances_.assign(all.size(), kNoDistance);
    survival_.resize(all.size());
    lag_.assign(all.size(), 0);
    base_.assign(all.size(), 0);
    delay_.assign(all.size(), 0);
    for_each_with(p.fill, all, [&](glm::ivec3, std::uint32_t i, std::uint32_t rank) {
      distances_[rank] = fill.distances[i];
      survival_[rank] = fill.survival[i];
      lag_[rank] = fill.lag[i];
      if (p.flow_tick == 0) return;
      base_[rank] = p.fill_base[i];
      delay_[rank] = p.fill_delay[i];
    });
    for_each_with(p.detached, all, [&](glm::ivec3, std::uint32_t i, std::uint32_t rank) {
      survival_[rank] = p.detached_survival[i];
      base_[rank] = p.detached_base[i];
      delay_[rank] = p.detached_delay[i];
      if (p.detached_delay[i] == 0) ++trapped_;
    });
  }

  // The flow ends when its last voxel has reached its new density.
  if (p.flow_tick != 0) {
    const std::uint16_t last =
        delay_.empty() ? std::uint16_t{0} : *std::max_element(delay_.begin(), delay_.end());
    flow_length_ = last + flow_ramp();
  }
  hash_ = content_hash();
}

std::uint64_t Cloud::content_hash() const {
  const CloudOrigin& o = parts_.origin;
  const auto whole = [](int number) { return static_cast<std::uint64_t>(std::int64_t{number}); };
  std::vector<std::uint64_t> words{whole(o.source.x),         whole(o.source.y),      whole(o.source.z),
                                   o.settings.voxels,         o.settings.bloom_ticks, o.settings.hold_ticks,
                                   o.settings.dissolve_ticks, o.detonation_tick,      parts_.flow_tick};
  for (const BlockSet* set : {&parts_.fill, &parts_.detached}) {
    words.push_back(set->size());
    for (const VoxelBlock& block : set->blocks())
      words.insert(words.end(), {whole(block.at.x), whole(block.at.y), whole(block.at.z), block.mask});
  }
  std::uint64_t hash = hash_values(std::span<const std::uint64_t>(words));
  hash = hash_values(std::span<const std::uint32_t>(distances_), hash);
  hash = hash_values(std::span<const std::uint8_t>(survival_), hash);
  hash = hash_values(std::span<const std::uint8_t>(lag_), hash);
  hash = hash_values(std::span<const std::uint8_t>(base_), hash);
  return hash_values(std::span<const std::uint16_t>(delay_), hash);
}

std::uint64_t Cloud::bytes() const {
  const std::uint64_t parts = parts_.fill.bytes() + parts_.detached.bytes() + 3 * parts_.fill_base.size() +
                              4 * parts_.detached.size();
  return sizeof(Cloud) + parts + all_voxels_.bytes() + 4 * distances_.size() + survival_.size() +
         lag_.size() + base_.size() + 2 * delay_.size() + sizeof(Flood::Count) * distance_counts_.size();
}

std::uint32_t Cloud::end_tick() const {
  const SmokeSettings& s = parts_.origin.settings;
  return parts_.origin.detonation_tick + s.bloom_ticks + s.hold_ticks + s.dissolve_ticks;
}

std::optional<std::uint32_t> Cloud::settle_tick() const {
  if (parts_.flow_tick == 0) return std::nullopt;
  return parts_.flow_tick + flow_length_;
}

std::uint64_t Cloud::amount(std::uint32_t tick) const {
  const CloudOrigin& o = parts_.origin;
  if (tick <= o.detonation_tick) return 0;
  const std::uint64_t age = std::min(tick - o.detonation_tick, o.settings.bloom_ticks);
  // Released fraction (1 - (1 - x)^3)^2: a few voxels in the first tick, then fast, then levelling off.
  constexpr std::uint64_t kOne = std::uint64_t{1} << kAmountBits;
  const std::uint64_t rest = (o.settings.bloom_ticks - age) * kOne / o.settings.bloom_ticks;  // 1 - x
  const std::uint64_t out = kOne - (((rest * rest) >> kAmountBits) * rest >> kAmountBits);
  return o.settings.voxels * ((out * out) >> kAmountBits);
}

/// Distance of the front at a tick: rises with each tick of the bloom, never falls, and encloses the nearest
/// amount(tick) voxels. Once the cloud has filled everything it can reach, the front advances at the same
/// speed: the excess makes the rim denser.
Front Cloud::front(std::uint32_t tick) const {
  return front_of(amount(tick), trapped_, distance_counts_);
}

Front Cloud::front_of(std::uint64_t out, std::uint32_t trapped_voxels, std::span<const Flood::Count> counts) {
  const std::uint64_t trapped = std::uint64_t{trapped_voxels} << kAmountBits;
  if (out <= trapped || counts.empty()) return 0;
  const std::uint64_t n = out - trapped;

  // The distance being filled: the front is there when the first of its voxels is due, and reaches the next
  // distance when the last one is.
  const std::uint64_t whole = (n + (1u << kAmountBits) - 1) >> kAmountBits;
  const auto at =
      std::lower_bound(counts.begin(), counts.end(), whole,
                       [](const Flood::Count& d, std::uint64_t count) { return d.count < count; });
  if (at == counts.end()) {
    // All is filled: continue at the mean speed so far.
    const Flood::Count& last = counts.back();
    const std::uint64_t over = n - (last.count << kAmountBits);
    const std::uint64_t pace = std::max<std::uint64_t>(1, last.count / std::max(last.distance, kFaceStep));
    return (last.distance + 1) * kFrontUnit + ((over / pace * kFrontUnit) >> kAmountBits);
  }

  // Between two distances the front moves with the amount.
  const std::uint64_t before = at == counts.begin() ? 0 : std::prev(at)->count;
  const std::uint64_t next = std::next(at) == counts.end() ? at->distance + 1 : std::next(at)->distance;
  const std::uint64_t gap = (next - at->distance) * kFrontUnit;
  const std::uint64_t due = n - (before << kAmountBits);
  return at->distance * kFrontUnit + (due / (at->count - before) * gap >> kAmountBits);
}

CloudPhase Cloud::undissolved_phase(std::uint32_t tick) const {
  CloudPhase m;
  m.front = front(tick);
  if (parts_.flow_tick != 0 && tick > parts_.flow_tick)
    m.flowed = std::min(tick - parts_.flow_tick, flow_length_);
  return m;
}

CloudPhase Cloud::phase(std::uint32_t tick) const {
  const CloudOrigin& o = parts_.origin;
  CloudPhase m = undissolved_phase(tick);
  const std::uint32_t dissolve = o.detonation_tick + o.settings.bloom_ticks + o.settings.hold_ticks;
  if (tick > dissolve)
    m.dissolved = static_cast<std::uint32_t>(
        std::min<std::uint64_t>(kWhole, std::uint64_t{tick - dissolve} * kWhole / o.settings.dissolve_ticks));
  return m;
}

std::uint8_t Cloud::profile(std::uint32_t distance, Front front) {
  const Front here = distance * kFrontUnit;
  if (here >= front) return 0;
  const std::uint64_t x = std::min<std::uint64_t>((front - here) * kWhole / taper(front), kWhole);
  return static_cast<std::uint8_t>((x * 255 + kWhole / 2) >> 16);
}

std::uint8_t Cloud::density(std::uint32_t rank, const CloudPhase& m) const {
  const std::uint32_t distance = distances_[rank];
  std::uint32_t density = distance == kNoDistance ? 0u : profile(reach(rank), m.front);
  if (!base_.empty()) {
    const std::uint32_t base = base_[rank];
    const std::uint32_t delay = delay_[rank];
    if (delay == 0) {
      if (distance == kNoDistance) density = base;
    } else {
      const std::uint64_t since = m.flowed > delay ? m.flowed - delay : 0;
      const std::uint64_t turned = smoothstep(std::min<std::uint64_t>(since * kWhole / flow_ramp(), kWhole));
      density =
          static_cast<std::uint32_t>((base * (kWhole - turned) + density * turned + kWhole / 2) / kWhole);
    }
  }
  if (m.dissolved == 0 || density == 0) return static_cast<std::uint8_t>(density);
  // A voxel starts to fade when its survival is exhausted, and is gone kDissolveSoft later.
  const std::uint32_t gone_at = survival_[rank] * kDissolveLast / 255 + kDissolveSoft;
  const std::uint32_t remaining = gone_at <= m.dissolved ? 0 : std::min(gone_at - m.dissolved, kDissolveSoft);
  return static_cast<std::uint8_t>((density * remaining + kDissolveSoft / 2) / kDissolveSoft);
}

std::uint8_t Cloud::density(glm::ivec3 voxel, const CloudPhase& m) const {
  const std::uint32_t rank = voxels().rank(voxel);
  return rank == BlockSet::kNone ? std::uint8_t{0} : density(rank, m);
}

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
  FillValues values =
      fill_values(parts.origin.source, parts.origin.detonation_tick, parts.fill, std::move(flood.distances));
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
  // Only the trapped part of the detached smoke remains.
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
  cloud.finish(fill_values(cloud.origin().source, cloud.origin().detonation_tick, cloud.parts_.fill,
                           std::move(distances)),
               distance_counts_);
  return cloud;
}

}  // namespace brume::sim
