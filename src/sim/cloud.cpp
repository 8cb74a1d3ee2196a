#include "sim/cloud.hpp"

#include <algorithm>
#include <array>
#include <string>

#include "core/error.hpp"
#include "core/hash.hpp"

namespace brume::sim {
namespace {

constexpr int kAmountBits = 20;

std::uint64_t key_of(glm::ivec3 brick) {
  return static_cast<std::uint64_t>(brick.x) | static_cast<std::uint64_t>(brick.y) << 16 |
         static_cast<std::uint64_t>(brick.z) << 32;
}

std::size_t local_of(glm::ivec3 v) {
  return static_cast<std::size_t>((v.x & 7) + 8 * (v.y & 7) + 64 * (v.z & 7));
}

}  // namespace

Cloud::Cloud(const voxel::BitGrid& grid, glm::ivec3 source, const SmokeSettings& settings,
             std::uint32_t detonation_tick)
    : settings_(settings), detonation_tick_(detonation_tick) {
  BRUME_ASSERT(settings.voxels >= 1 && settings.voxels <= kMaxFillVoxels, std::to_string(settings.voxels));
  BRUME_ASSERT(settings.bloom_ticks >= 1, std::to_string(settings.bloom_ticks));
  voxels_ = flood_fill(grid, source, settings.voxels);

  const std::array<std::uint32_t, 3> numbers{settings.voxels, settings.bloom_ticks, detonation_tick};
  hash_ = hash_values(std::span<const std::uint32_t>(numbers));
  hash_ = hash_bytes(std::as_bytes(std::span(voxels_)), hash_);

  low_ = voxels_.empty() ? glm::ivec3(0) : voxels_.front().voxel;
  high_ = low_ - (voxels_.empty() ? 1 : 0);
  for (const FilledVoxel& filled : voxels_) {
    low_ = glm::min(low_, filled.voxel);
    high_ = glm::max(high_, filled.voxel);
    if (levels_.empty() || levels_.back().distance != filled.distance)
      levels_.push_back({filled.distance, 0});
    levels_.back().count = static_cast<std::uint64_t>(&filled - voxels_.data()) + 1;
  }
  keep_distances();
}

/// Brick by brick: one entry in a hash map a voxel would take as long as the fill itself.
void Cloud::keep_distances() {
  for (const FilledVoxel& filled : voxels_) {
    const auto [entry, is_new] =
        brick_of_.try_emplace(key_of(filled.voxel >> 3), static_cast<std::uint32_t>(bricks_.size()));
    if (is_new) bricks_.emplace_back();
    bricks_[entry->second][local_of(filled.voxel)] = filled.distance + 1;
  }
}

std::uint64_t Cloud::amount(std::uint32_t tick) const {
  if (tick <= detonation_tick_) return 0;
  const std::uint64_t age = std::min(tick - detonation_tick_, settings_.bloom_ticks);
  // Share (1 - (1 - x)^3)^2: a few voxels in the first tick, then fast, then ebbing.
  constexpr std::uint64_t kOne = std::uint64_t{1} << kAmountBits;
  const std::uint64_t left = (settings_.bloom_ticks - age) * kOne / settings_.bloom_ticks;
  const std::uint64_t out = kOne - (((left * left) >> kAmountBits) * left >> kAmountBits);
  return settings_.voxels * ((out * out) >> kAmountBits);
}

Front Cloud::front(std::uint32_t tick) const {
  const std::uint64_t n = amount(tick);
  if (n == 0 || levels_.empty()) return 0;

  // The level that the amount is filling: the front is at its distance when the first of its voxels is due,
  // and comes to the next level's when the last one is.
  const std::uint64_t whole = (n + (1u << kAmountBits) - 1) >> kAmountBits;
  const auto level = std::lower_bound(levels_.begin(), levels_.end(), whole,
                                      [](const Level& l, std::uint64_t count) { return l.count < count; });
  if (level == levels_.end()) {
    // All is filled: on at the mean pace so far.
    const Level& last = levels_.back();
    const std::uint64_t over = n - (last.count << kAmountBits);
    const std::uint64_t pace = std::max<std::uint64_t>(1, last.count / std::max(last.distance, kFaceStep));
    return (last.distance + 1) * kFrontUnit + ((over / pace * kFrontUnit) >> kAmountBits);
  }
  const std::uint64_t before = level == levels_.begin() ? 0 : std::prev(level)->count;
  const std::uint64_t next =
      std::next(level) == levels_.end() ? level->distance + 1 : std::next(level)->distance;
  const std::uint64_t gap = (next - level->distance) * kFrontUnit;
  const std::uint64_t due = n - (before << kAmountBits);
  return level->distance * kFrontUnit + (due / (level->count - before) * gap >> kAmountBits);
}

std::uint8_t Cloud::density_at(std::uint32_t distance, Front front) {
  const Front here = distance * kFrontUnit;
  if (here >= front) return 0;
  const Front taper = std::max<Front>(2 * kFaceStep * kFrontUnit, front / 4);
  const std::uint64_t x = std::min<std::uint64_t>((front - here) * 65536 / taper, 65536);
  const std::uint64_t smooth = (x * x * (3 * 65536 - 2 * x)) >> 32;  // of 65536
  return static_cast<std::uint8_t>((smooth * 255 + 32768) >> 16);
}

std::optional<std::uint32_t> Cloud::distance(glm::ivec3 voxel) const {
  if (glm::any(glm::lessThan(voxel, low_)) || glm::any(glm::greaterThan(voxel, high_))) return std::nullopt;
  const auto found = brick_of_.find(key_of(voxel >> 3));
  const std::uint32_t kept = found == brick_of_.end() ? 0 : bricks_[found->second][local_of(voxel)];
  return kept == 0 ? std::nullopt : std::optional(kept - 1);
}

}  // namespace brume::sim
