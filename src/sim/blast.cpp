#include "sim/blast.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "core/hash.hpp"
#include "core/tasks.hpp"
#include "sim/event_fields.hpp"
#include "sim/fixed_point.hpp"

namespace brume::sim {
namespace {

constexpr std::int64_t kSub = 1024;  // subvoxels per voxel
/// The effect fades out between the radius and 6/5 of it, where reach is 255.
constexpr std::uint64_t kRimNum = 6, kRimDen = 5;
constexpr std::uint32_t kFullReach = 255 * kRimDen / kRimNum;
/// Time a voxel takes to open once the front has arrived.
constexpr std::uint64_t kOpenMilliseconds = 50;

/// floor(sqrt(square)) for square < 2^52. Exact: IEEE square roots are correctly rounded.
std::int64_t floor_sqrt(std::int64_t square) {
  auto root = static_cast<std::int64_t>(std::sqrt(static_cast<double>(square)));
  while (root * root > square) --root;
  while ((root + 1) * (root + 1) <= square) ++root;
  return root;
}

/// The solid voxels of a box, one byte each, so that a step along a ray is one addition.
class SolidBox {
 public:
  SolidBox(const voxel::BitGrid& grid, glm::ivec3 low, glm::ivec3 high)
      : low_(low),
        size_(high - low + 1),
        solid_(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
               static_cast<std::size_t>(size_.z)) {
    const glm::ivec3 first = glm::max(low, glm::ivec3(0)), last = glm::min(high, grid.size() - 1);
    for (int z = first.z; z <= last.z; ++z)
      for (int y = first.y; y <= last.y; ++y)
        for (int x = first.x; x <= last.x; ++x) solid_[index({x, y, z})] = grid.solid({x, y, z});
  }
  std::size_t index(glm::ivec3 v) const {
    const glm::ivec3 in = v - low_;
    return static_cast<std::size_t>(in.x) + stride(1) * static_cast<std::size_t>(in.y) +
           stride(2) * static_cast<std::size_t>(in.z);
  }
  std::size_t stride(int axis) const {
    const auto x = static_cast<std::size_t>(size_.x), y = static_cast<std::size_t>(size_.y);
    return axis == 0 ? 1 : axis == 1 ? x : x * y;
  }
  bool operator[](std::size_t i) const { return solid_[i] != 0; }

 private:
  glm::ivec3 low_, size_;
  std::vector<std::uint8_t> solid_;
};

/// Whether the segment from a point to the centre of a voxel meets no solid voxel before it. Along an edge x
/// steps before y, y before z. Both ends lie in the box, which is at most 2^10 voxels wide.
bool in_sight(const SolidBox& box, glm::i64vec3 from, glm::ivec3 target) {
  const glm::i64vec3 to = glm::i64vec3(target) * kSub + kSub / 2;
  const glm::i64vec3 path = to - from, length = glm::max(glm::abs(path), std::int64_t{1});
  // Times to the next face on each axis, scaled by the path's lengths on the other axes: integers.
  constexpr std::int64_t kNever = std::numeric_limits<std::int64_t>::max();
  const glm::i64vec3 others(length.y * length.z, length.x * length.z, length.x * length.y);
  glm::i64vec3 next(kNever), step_time(0);
  std::array<std::size_t, 3> step{};  // downward steps wrap around
  for (int axis = 0; axis < 3; ++axis) {
    if (path[axis] == 0) continue;
    const std::int64_t in_voxel = from[axis] & (kSub - 1);
    const std::size_t stride = box.stride(axis);
    step[static_cast<std::size_t>(axis)] = path[axis] > 0 ? stride : std::size_t{0} - stride;
    next[axis] = (path[axis] > 0 ? kSub - in_voxel : in_voxel) * others[axis];
    step_time[axis] = kSub * others[axis];
  }

  // Step to the nearest face until the target is reached.
  const std::size_t end = box.index(target);
  for (std::size_t at = box.index(glm::ivec3(from >> std::int64_t{10})); at != end;) {
    if (box[at]) return false;
    const int axis = next.x <= next.y && next.x <= next.z ? 0 : next.y <= next.z ? 1 : 2;
    at += step[static_cast<std::size_t>(axis)];
    next[axis] += step_time[axis];
  }
  return true;
}

}  // namespace

BlastField::BlastField(const voxel::BitGrid& grid, const Blast& blast, std::uint32_t ticks_per_second)
    : event_(blast), centre_(blast.at), ticks_per_second_(ticks_per_second) {
  // A blast inside a wall moves to the nearest free voxel.
  const VoxelRuler ruler(grid.layout());
  glm::i64vec3 from = ruler.subvoxel(centre_);
  if (grid.solid(glm::ivec3(from >> std::int64_t{10}))) {
    const auto nearest = nearest_free_voxel(grid, glm::ivec3(from >> std::int64_t{10}));
    if (!nearest) {
      finish(grid.layout());
      return;
    }
    centre_ = ruler.centre(*nearest);
    from = ruler.subvoxel(centre_);
  }

  // Test every free voxel of the ball, slice by slice.
  const std::int64_t limit = ruler.subvoxels(blast.radius) * std::int64_t{kRimNum} / std::int64_t{kRimDen};
  const glm::ivec3 box_low((from - limit) >> std::int64_t{10}), box_high((from + limit) >> std::int64_t{10});
  const SolidBox box(grid, box_low, box_high);
  const glm::ivec3 low = glm::max(box_low, glm::ivec3(0)), high = glm::min(box_high, grid.size() - 1);
  std::vector<std::vector<glm::ivec3>> slices(static_cast<std::size_t>(std::max(0, high.z - low.z + 1)));
  parallel_for(slices.size(), 8, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for (int y = low.y; y <= high.y; ++y)
        for (int x = low.x; x <= high.x; ++x) {
          const glm::ivec3 v(x, y, low.z + static_cast<int>(i));
          const glm::i64vec3 d = glm::i64vec3(v) * kSub + kSub / 2 - from;
          if (d.x * d.x + d.y * d.y + d.z * d.z > limit * limit || box[box.index(v)]) continue;
          if (in_sight(box, from, v)) slices[i].push_back(v);
        }
  });
  std::vector<glm::ivec3> voxels;
  for (const auto& slice : slices) voxels.insert(voxels.end(), slice.begin(), slice.end());
  reached_ = BlockSet(voxels);
  finish(grid.layout());
}

Result<BlastField> BlastField::from_parts(const voxel::GridLayout& layout, const Blast& blast,
                                          Position centre, BlockSet reached, std::uint32_t ticks_per_second) {
  if (auto ok = check_event(blast, layout); !ok) return ok.failure();
  if (auto ok = check_event(MoveBody{blast.tick, 0, centre}, layout); !ok) return ok.failure();
  const VoxelRuler ruler(layout);
  const glm::i64vec3 from = ruler.subvoxel(centre);
  const std::int64_t limit = ruler.subvoxels(blast.radius) * std::int64_t{kRimNum} / std::int64_t{kRimDen};
  bool within = true;
  reached.for_each([&](glm::ivec3 v, std::uint32_t) {
    const glm::i64vec3 d = glm::i64vec3(v) * kSub + kSub / 2 - from;
    within &= d.x * d.x + d.y * d.y + d.z * d.z <= limit * limit;
  });
  if (!within) return Failure{ErrorCode::bad_input, "blast: expected all voxels within its radius"};
  BlastField field;
  field.event_ = blast;
  field.centre_ = centre;
  field.ticks_per_second_ = ticks_per_second;
  field.reached_ = std::move(reached);
  field.finish(layout);
  return field;
}

/// Computes the distance of each reached voxel, the end tick and the hash.
void BlastField::finish(const voxel::GridLayout& layout) {
  // The distance of each voxel, scaled to [0, 255].
  const VoxelRuler ruler(layout);
  const glm::i64vec3 from = ruler.subvoxel(centre_);
  const std::int64_t limit = std::max<std::int64_t>(
      1, ruler.subvoxels(event_.radius) * std::int64_t{kRimNum} / std::int64_t{kRimDen});
  reach_.resize(reached_.size());
  reached_.for_each([&](glm::ivec3 v, std::uint32_t rank) {
    const glm::i64vec3 d = glm::i64vec3(v) * kSub + kSub / 2 - from;
    const std::int64_t distance = floor_sqrt(d.x * d.x + d.y * d.y + d.z * d.z);
    reach_[rank] = static_cast<std::uint8_t>(std::min<std::int64_t>(255, distance * 255 / limit));
  });

  // The end: when the last distance has refilled.
  end_tick_ = event_.tick;
  const std::uint64_t tps = ticks_per_second_;
  for (std::uint32_t reach = 0; reach < 256; ++reach) {
    const std::uint64_t over = arrival_ms(reach) + kOpenMilliseconds + refill_ms(reach);
    end_tick_ = std::max(end_tick_, event_.tick + static_cast<std::uint32_t>((over * tps + 999) / 1000));
  }

  // The hash of the blast, its voxels and their distances.
  std::vector<std::uint64_t> words{event_.tick,      event_.radius,        event_.speed,
                                   event_.remaining, event_.refill_rim_ms, event_.refill_middle_ms};
  for (const Position p : {event_.at, centre_})
    for (int axis = 0; axis < 3; ++axis) words.push_back(static_cast<std::uint64_t>(std::int64_t{p[axis]}));
  for (const VoxelBlock& block : reached_.blocks()) {
    for (int axis = 0; axis < 3; ++axis)
      words.push_back(static_cast<std::uint64_t>(std::int64_t{block.at[axis]}));
    words.push_back(block.mask);
  }
  hash_ =
      hash_values(std::span<const std::uint8_t>(reach_), hash_values(std::span<const std::uint64_t>(words)));
}

std::uint64_t BlastField::arrival_ms(std::uint32_t reach) const {
  return std::uint64_t{event_.radius} * reach * kRimNum * 1000 / (255 * kRimDen * event_.speed);
}

std::uint64_t BlastField::refill_ms(std::uint32_t reach) const {
  const std::uint32_t r = std::min(reach, kFullReach);
  return (std::uint64_t{event_.refill_middle_ms} * (kFullReach - r) +
          std::uint64_t{event_.refill_rim_ms} * r) /
         kFullReach;
}

BlastProfile BlastField::profile(std::uint32_t tick) const {
  BlastProfile m;
  m.remaining.fill(255);
  if (tick <= event_.tick || tick >= end_tick_) return m;
  const std::uint64_t age_us = std::uint64_t{tick - event_.tick} * 1'000'000 / ticks_per_second_;
  for (std::uint32_t reach = 0; reach < 256; ++reach) {
    const std::uint64_t arrival = arrival_ms(reach) * 1000;
    if (age_us <= arrival) continue;
    const std::uint64_t since = age_us - arrival, open = kOpenMilliseconds * 1000;
    std::uint64_t cleared = smoothstep(std::min(since * kWhole / open, kWhole));
    if (since > open) {
      // Refills as smoothstep^1.8, approximated by (s + 4 s^2) / 5: error below 0.018.
      const std::uint64_t s =
          smoothstep(std::min((since - open) * kWhole / (refill_ms(reach) * 1000), kWhole));
      cleared = kWhole - (s + 4 * (s * s >> 16)) / 5;
    }
    if (reach > kFullReach)
      cleared = cleared * smoothstep((255 - reach) * kWhole / (255 - kFullReach)) / kWhole;
    m.remaining[reach] =
        static_cast<std::uint8_t>(255 - ((255 - event_.remaining) * cleared + kWhole / 2) / kWhole);
  }
  return m;
}

}  // namespace brume::sim
