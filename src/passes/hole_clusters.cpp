#include "passes/hole_clusters.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "brume_shaders.hpp"

namespace brume::passes {
namespace {

constexpr std::uint32_t kMaxBlocks = 7000;  // 112 MiB of cells: every device takes 128 in one buffer
constexpr std::size_t kMaxWords = 1 << 24;  // of the lists: 64 MiB
// Workgroups that share the work of a pass, however much it turns out to be.
constexpr std::uint32_t kGroups = 8192;
constexpr std::uint32_t kRow = 32768;  // every device takes 65,535 workgroups along an axis

/// How many bricks a hole can reach: their centres lie in its capsule grown by half their diagonal, and so
/// all of them lie in the capsule grown by a whole one.
double bricks_reached(const shared::HoleReach& reach, float voxel_size) {
  constexpr double kEdge = shared::kBrickVoxels;
  const double radius = static_cast<double>(reach.radius) / static_cast<double>(voxel_size);
  const double length = static_cast<double>(reach.length_m) / static_cast<double>(voxel_size);
  const double r = radius + std::numbers::sqrt3 * kEdge;
  return std::numbers::pi * r * r * (length + 4.0 / 3 * r) / (kEdge * kEdge * kEdge) + 1;
}

/// Whether it is wide open wherever it is: hole_opening gives 1 and 1 at both ends, and so between.
bool is_wide_open(const shared::Hole& hole, float time) {
  constexpr float kTolerance = 1e-4f;  // [s], for rounding
  const float at_muzzle = time - hole.time_start, at_far = at_muzzle - hole.time_to_reach_far;
  return at_far > hole.time_to_expand + kTolerance &&
         at_muzzle < hole.time_to_expand + hole.time_to_stay_open - kTolerance;
}

/// Most words that the lists of a group may take: a block for each 32 holes at worst, a list in each slice.
std::size_t max_words_of_tile(std::size_t holes) {
  return (holes + 31) / 32 * shared::kChunkWords +
         shared::kHoleSlices * ((holes + 1) / 2 + (holes + 31) / 32);
}

}  // namespace

HolePlan plan_holes(std::span<const shared::Hole> holes, float time, float rim,
                    const shared::VolumeLayout& volume, std::uint32_t slot_count) {
  const glm::vec3 low = volume.origin_world + volume.bounds_min * volume.voxel_size;
  const glm::vec3 high = volume.origin_world + volume.bounds_max * volume.voxel_size;
  HolePlan plan;
  double pairs = 0;
  // From the last on, so that the first of too many are left out.
  for (std::size_t i = holes.size(); i-- > 0 && plan.holes.size() < shared::kMaxHoles;) {
    const shared::HoleReach open = shared::hole_reach(holes[i], time, rim);
    const shared::HoleReach reach = shared::hole_reach_within(open, low, high);
    if (open.length_m < 0 || reach.length_m < 0) continue;
    plan.holes.push_back(holes[i]);
    plan.reaches.push_back(reach);
    pairs += std::min(bricks_reached(reach, volume.voxel_size), static_cast<double>(slot_count));
  }
  std::reverse(plan.holes.begin(), plan.holes.end());
  std::reverse(plan.reaches.begin(), plan.reaches.end());
  plan.pair_capacity =
      static_cast<std::uint32_t>(std::min(std::ceil(pairs), static_cast<double>(kMaxHolePairs)));
  plan.block_capacity = std::min({slot_count, plan.pair_capacity, kMaxBlocks});
  return plan;
}

std::vector<shared::PackedHole> pack_holes(std::span<const shared::Hole> holes, float time) {
  std::vector<shared::PackedHole> packed;
  packed.reserve(holes.size());
  for (const shared::Hole& hole : holes) packed.push_back(shared::pack_hole(hole, is_wide_open(hole, time)));
  return packed;
}

HoleClusters::HoleClusters(gpu::Context& context, gpu::CommandRunner& runner, const smoke::MaskAtlas& masks)
    : context_(context),
      tiles_pass_(context, shaders::hole_coarse_tiles_comp),
      groups_pass_(context, shaders::hole_clusters_comp),
      bricks_pass_(context, shaders::hole_bricks_comp),
      cells_pass_(context, shaders::hole_cells_comp),
      nearest_(context, {VK_FILTER_NEAREST}),
      counters_(context, sizeof(shared::HoleCounters),
                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      words_taken_(context, sizeof(std::uint32_t),
                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  reserve({}, 0, 0, {}, 0, {1, 1});
  set_masks(context, runner, masks);
}

void HoleClusters::set_masks(gpu::Context& context, gpu::CommandRunner& runner,
                             const smoke::MaskAtlas& masks) {
  runner.run([&](gpu::Recorder& recorder) { resources_.masks = make_hole_masks(context, recorder, masks); });
}

void HoleClusters::reserve(std::span<const shared::Hole> holes, float time, float rim,
                           const shared::VolumeLayout& volume, std::uint32_t slot_count, glm::uvec2 size_px) {
  time_ = time;
  plan_ = slot_count > 0 ? plan_holes(holes, time, rim, volume, slot_count) : HolePlan();
  slot_count_ = slot_count;
  resources_.any = !plan_.holes.empty();
  constexpr std::uint32_t kTilePixels = shared::kCoarseTileTiles * shared::kHoleTilePixels;
  tiles_ = (size_px + kTilePixels - 1u) / kTilePixels;
  const std::size_t tiles = std::size_t{tiles_.x} * tiles_.y;
  const std::size_t groups = tiles * shared::kCoarseTileTiles * shared::kCoarseTileTiles;
  const std::size_t count = plan_.holes.size(), words = (count + 31) / 32;
  entries_at_ = static_cast<std::uint32_t>(groups);
  entry_capacity_ = static_cast<std::uint32_t>(std::min(groups * max_words_of_tile(count), kMaxWords));
  gpu::grow(context_, resources_.holes, count * sizeof(shared::PackedHole));
  gpu::grow(context_, resources_.reaches, count * sizeof(shared::PackedReach));
  gpu::grow(context_, coarse_tile_holes_, tiles * words * sizeof(std::uint32_t));
  gpu::grow(context_, resources_.lists, (std::size_t{entries_at_} + entry_capacity_) * sizeof(std::uint32_t));
  gpu::grow(
      context_, resources_.cells,
      (slot_count + std::size_t{plan_.block_capacity} * shared::kHoleCellsPerChunk) * sizeof(std::uint32_t));
  gpu::grow(context_, pairs_, plan_.pair_capacity * sizeof(glm::uvec2));
}

shared::HoleClusterLayout HoleClusters::layout() const {
  // Without smoke nothing is listed, and nobody may look.
  const auto count = resources_.any ? static_cast<std::uint32_t>(plan_.holes.size()) : 0u;
  return {count, tiles_.x * shared::kCoarseTileTiles, entries_at_, slot_count_};
}

void HoleClusters::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SmokeResources& smoke) {
  if (!resources_.any) return;
  recorder.fill(counters_, 0);
  recorder.fill(words_taken_, 0);
  const auto holes = pack_holes(plan_.holes, time_);
  recorder.upload(resources_.holes, 0, std::as_bytes(std::span(holes)));
  std::vector<shared::PackedReach> reaches;
  for (const shared::HoleReach& reach : plan_.reaches) reaches.push_back(shared::pack_reach(reach));
  recorder.upload(resources_.reaches, 0, std::as_bytes(std::span(reaches)));
  const shared::HoleListsParams lists{entry_capacity_};
  const shared::HoleCellsParams cells{slot_count_, plan_.pair_capacity, plan_.block_capacity};
  const auto bytes = [](const auto& params) { return std::as_bytes(std::span(&params, 1)); };
  constexpr std::uint32_t kPerTile = shared::kCoarseTileTiles / 2;  // workgroups, along an axis
  // What pixels need and what light needs depend on nothing of each other.
  recorder.dispatch_together({{tiles_pass_,
                               {{shared::kBindFrame, gpu::uniform(frame)},
                                {shared::kBindHoleReaches, gpu::read(resources_.reaches)},
                                {shared::kBindCoarseTileHoles, gpu::write(coarse_tile_holes_)}},
                               {tiles_pass_.group()[0] * tiles_.x, tiles_.y, 1}},
                              {bricks_pass_,
                               {
                                   {shared::kBindFrame, gpu::uniform(frame)},
                                   {shared::kBindSlotBricks, gpu::read(smoke.slot_bricks)},
                                   {shared::kBindHoleReaches, gpu::read(resources_.reaches)},
                                   {shared::kBindHoleCells, gpu::read_write(resources_.cells)},
                                   {shared::kBindHolePairs, gpu::write(pairs_)},
                                   {shared::kBindHoleCounters, gpu::read_write(counters_)},
                               },
                               {64 * std::min(slot_count_, kRow), (slot_count_ + kRow - 1) / kRow, 1},
                               bytes(cells)}});
  recorder.dispatch_together({{groups_pass_,
                               {
                                   {shared::kBindFrame, gpu::uniform(frame)},
                                   {shared::kBindHoleReaches, gpu::read(resources_.reaches)},
                                   {shared::kBindCoarseTileHoles, gpu::read(coarse_tile_holes_)},
                                   {shared::kBindHoleLists, gpu::write(resources_.lists)},
                                   {shared::kBindHoleWordsTaken, gpu::read_write(words_taken_)},
                               },
                               {groups_pass_.group()[0] * kPerTile * tiles_.x, kPerTile * tiles_.y, 1},
                               bytes(lists)},
                              {cells_pass_,
                               {
                                   {shared::kBindFrame, gpu::uniform(frame)},
                                   {shared::kBindSlotBricks, gpu::read(smoke.slot_bricks)},
                                   {shared::kBindHoles, gpu::read(resources_.holes)},
                                   {shared::kBindHoleReaches, gpu::read(resources_.reaches)},
                                   {shared::kBindHoleCells, gpu::read_write(resources_.cells)},
                                   {shared::kBindHolePairs, gpu::read(pairs_)},
                                   {shared::kBindHoleCounters, gpu::read(counters_)},
                                   {shared::kBindHoleMasks, gpu::sampled(resources_.masks, nearest_)},
                               },
                               {64 * std::min(kGroups, plan_.pair_capacity), 1, 1},
                               bytes(cells)}});
}

}  // namespace brume::passes
