#include "planning/hole_plan.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numbers>

namespace brume::planning {
namespace {

constexpr std::uint32_t kMaxChunks = 7000;  // 112 MiB of cells: every device takes 128 in one buffer
constexpr std::size_t kMaxWords = 1 << 24;  // in the lists: 64 MiB

/// How many bricks a hole can reach: their centres lie in its capsule grown by half their diagonal, and so
/// all of them lie in the capsule grown by a whole one.
double bricks_reached(const shared::HoleReach& reach, float voxel_size) {
  constexpr double kEdge = shared::kBrickVoxels;
  const double radius = static_cast<double>(reach.radius) / static_cast<double>(voxel_size);
  const double length = static_cast<double>(reach.length_m) / static_cast<double>(voxel_size);
  const double r = radius + std::numbers::sqrt3 * kEdge;
  return std::numbers::pi * r * r * (length + 4.0 / 3 * r) / (kEdge * kEdge * kEdge) + 1;
}

/// Whether a hole is wide open over its whole length: hole_opening is 1 at both ends, and so between.
bool is_wide_open(const shared::Hole& hole, float time) {
  constexpr float kTolerance = 1e-4f;  // [s], for rounding
  const float at_muzzle = time - hole.time_start, at_far = at_muzzle - hole.time_to_reach_far;
  return at_far > hole.time_to_expand + kTolerance &&
         at_muzzle < hole.time_to_expand + hole.time_to_stay_open - kTolerance;
}

/// Most words that the lists of a tile may take: a chunk for each 32 holes at worst, a list in each slice.
std::size_t max_words_of_tile(std::size_t holes) {
  return (holes + 31) / 32 * shared::kChunkWords +
         shared::kHoleSlices * ((holes + 1) / 2 + (holes + 31) / 32);
}

/// Chooses the holes and counts the bricks that they meet.
void choose_holes(HolePlan& plan, std::span<const shared::Hole> holes, float rim,
                  const shared::VolumeLayout& volume) {
  const glm::vec3 low = volume.origin_world + volume.bounds_min * volume.voxel_size;
  const glm::vec3 high = volume.origin_world + volume.bounds_max * volume.voxel_size;
  double pairs = 0;
  // Backwards, so that the first holes are omitted where there are too many.
  for (std::size_t i = holes.size(); i-- > 0 && plan.holes.size() < shared::kMaxHoles;) {
    const shared::HoleReach open = shared::hole_reach(holes[i], plan.time, rim);
    const shared::HoleReach reach = shared::hole_reach_within(open, low, high);
    if (open.length_m < 0 || reach.length_m < 0) continue;
    plan.holes.push_back(holes[i]);
    plan.reaches.push_back(reach);
    pairs += std::min(bricks_reached(reach, volume.voxel_size), static_cast<double>(plan.slot_count));
  }
  std::reverse(plan.holes.begin(), plan.holes.end());
  std::reverse(plan.reaches.begin(), plan.reaches.end());
  plan.pair_capacity =
      static_cast<std::uint32_t>(std::min(std::ceil(pairs), static_cast<double>(kMaxHolePairs)));
  plan.chunk_capacity = std::min({plan.slot_count, plan.pair_capacity, kMaxChunks});
}

}  // namespace

shared::HoleClusterLayout HolePlan::layout() const {
  return {static_cast<std::uint32_t>(holes.size()), coarse_tiles.x * shared::kCoarseTileTiles, cluster_count,
          slot_count};
}

HolePlan plan_holes(std::span<const shared::Hole> holes, float time, float rim,
                    const shared::VolumeLayout& volume, std::uint32_t slot_count, glm::uvec2 size_px,
                    Allocator memory) {
  HolePlan plan{.holes = FrameVector<shared::Hole>(memory),
                .reaches = FrameVector<shared::HoleReach>(memory)};
  plan.time = time;
  plan.slot_count = slot_count;
  if (slot_count > 0) choose_holes(plan, holes, rim, volume);
  constexpr std::uint32_t kTilePixels = shared::kCoarseTileTiles * shared::kHoleTilePixels;
  plan.coarse_tiles = (size_px + kTilePixels - 1u) / kTilePixels;
  const std::size_t tiles = std::size_t{plan.coarse_tiles.x} * plan.coarse_tiles.y *
                            shared::kCoarseTileTiles * shared::kCoarseTileTiles;
  plan.cluster_count = static_cast<std::uint32_t>(tiles);
  plan.word_capacity =
      static_cast<std::uint32_t>(std::min(tiles * max_words_of_tile(plan.holes.size()), kMaxWords));
  return plan;
}

FrameVector<shared::PackedHole> pack_holes(std::span<const shared::Hole> holes, float time,
                                           Allocator memory) {
  FrameVector<shared::PackedHole> packed(memory);
  packed.reserve(holes.size());
  for (const shared::Hole& hole : holes) packed.push_back(shared::pack_hole(hole, is_wide_open(hole, time)));
  return packed;
}

FrameVector<shared::PackedReach> pack_reaches(std::span<const shared::HoleReach> reaches, Allocator memory) {
  FrameVector<shared::PackedReach> packed(memory);
  packed.reserve(reaches.size());
  for (const shared::HoleReach& reach : reaches) packed.push_back(shared::pack_reach(reach));
  return packed;
}

}  // namespace brume::planning
