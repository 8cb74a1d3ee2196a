#include "passes/open_holes.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "brume_shaders.hpp"

namespace brume::passes {
namespace {

constexpr std::uint32_t kMaxBlocks = 7000;    // 112 MiB of cells: every device takes 128 in one buffer
constexpr std::uint32_t kGroupsPerTile = 8;   // along an axis
constexpr std::size_t kMaxEntries = 1 << 23;  // of the lists: 32 MiB
// Workgroups that share the work of a pass, however much it turns out to be.
constexpr std::uint32_t kGroups = 8192;
constexpr std::uint32_t kRow = 32768;  // every device takes 65,535 workgroups along an axis

/// How many bricks a hole can reach: their centres lie in its capsule grown by half their diagonal, and so
/// all of them lie in the capsule grown by a whole one.
double bricks_reached(const shared::Hole& hole, float voxel_size) {
  constexpr double kEdge = shared::kBrickVoxels;
  const double corner = hole.shape == shared::kHoleCylinder ? 1 : std::numbers::sqrt2;
  const double radius = corner * static_cast<double>(hole.radius) / static_cast<double>(voxel_size);
  const double length = static_cast<double>(hole.distance_to_far) / static_cast<double>(voxel_size);
  const double r = radius + std::numbers::sqrt3 * kEdge;
  return std::numbers::pi * r * r * (length + 4.0 / 3 * r) / (kEdge * kEdge * kEdge) + 1;
}

bool is_open(const shared::Hole& hole, float time) {
  constexpr float kSlack = 1e-3f;  // [s]
  const float age = time - hole.time_start;
  return age > 0 && age < hole.time_to_reach_far + hole.time_to_expand + hole.time_to_stay_open +
                              hole.time_to_fade + kSlack;
}

}  // namespace

HolePlan plan_holes(std::span<const shared::Hole> holes, float time, float voxel_size,
                    std::uint32_t slot_count) {
  HolePlan plan;
  for (const shared::Hole& hole : holes)
    if (is_open(hole, time)) plan.holes.push_back(hole);
  if (plan.holes.size() > shared::kMaxHoles)
    plan.holes.erase(plan.holes.begin(), plan.holes.end() - shared::kMaxHoles);
  double pairs = 0;
  for (const shared::Hole& hole : plan.holes)
    pairs += std::min(bricks_reached(hole, voxel_size), static_cast<double>(slot_count));
  plan.pair_capacity =
      static_cast<std::uint32_t>(std::min(std::ceil(pairs), static_cast<double>(kMaxHolePairs)));
  plan.block_capacity = std::min({slot_count, plan.pair_capacity, kMaxBlocks});
  return plan;
}

OpenHoles::OpenHoles(gpu::Context& context, gpu::CommandRunner& runner, const sim::MaskAtlas& masks)
    : context_(context),
      tiles_pass_(context, shaders::hole_tiles_comp, {gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer},
                  sizeof(shared::HoleListsParams), {64, 1, 1}),
      slabs_pass_(context, shaders::hole_slabs_comp, {gpu::kBuffer, gpu::kBuffer, gpu::kBuffer}, 0,
                  {shared::kHoleSlabs, 2, 1}),
      bricks_pass_(context, shaders::hole_bricks_comp,
                   {gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer},
                   sizeof(shared::HoleCellsParams), {64, 1, 1}),
      cells_pass_(
          context, shaders::hole_cells_comp,
          {gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kSampled},
          sizeof(shared::HoleCellsParams), {64, 1, 1}),
      nearest_(context, {VK_FILTER_NEAREST}),
      counters_(context, sizeof(shared::HoleCounters),
                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  reserve({}, 0, 1, 0, {1, 1});
  runner.run([&](gpu::Recorder& recorder) { resources_.masks = make_hole_masks(context, recorder, masks); });
}

void OpenHoles::reserve(std::span<const shared::Hole> holes, float time, float voxel_size,
                        std::uint32_t slot_count, glm::uvec2 size_px) {
  plan_ = plan_holes(holes, time, voxel_size, slot_count);
  slot_count_ = slot_count;
  resources_.any = !plan_.holes.empty() && slot_count > 0;
  constexpr std::uint32_t kTilePixels = kGroupsPerTile * shared::kHoleGroupPixels;
  tiles_ = (size_px + kTilePixels - 1u) / kTilePixels;
  const std::size_t groups = std::size_t{tiles_.x} * tiles_.y * kGroupsPerTile * kGroupsPerTile;
  entries_at_ = static_cast<std::uint32_t>(2 * groups);
  const std::size_t listed = plan_.holes.size();
  const std::size_t words_of_all = listed + shared::kHoleSlabs * ((listed + 31) / 32);
  entry_capacity_ = static_cast<std::uint32_t>(std::min(groups * words_of_all, kMaxEntries));
  gpu::grow(context_, resources_.holes, plan_.holes.size() * sizeof(shared::Hole));
  gpu::grow(context_, resources_.lists, (std::size_t{entries_at_} + entry_capacity_) * sizeof(std::uint32_t));
  gpu::grow(
      context_, resources_.cells,
      (slot_count + std::size_t{plan_.block_capacity} * shared::kHoleCellsPerBlock) * sizeof(std::uint32_t));
  gpu::grow(context_, pairs_, plan_.pair_capacity * sizeof(glm::uvec2));
}

shared::OpenHolesFrame OpenHoles::frame() const {
  // Without smoke nothing is listed, and nobody may look.
  const auto count = resources_.any ? static_cast<std::uint32_t>(plan_.holes.size()) : 0u;
  return {count, tiles_.x * kGroupsPerTile, entries_at_, slot_count_};
}

void OpenHoles::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SmokeResources& smoke) {
  if (!resources_.any) return;
  recorder.upload(resources_.holes, 0, std::as_bytes(std::span(plan_.holes)));
  recorder.fill(counters_, 0);
  recorder.bind(tiles_pass_,
                {gpu::read(frame), gpu::read(resources_.holes), gpu::write(resources_.lists),
                 gpu::read_write(counters_)},
                shared::HoleListsParams{entry_capacity_});
  recorder.dispatch_threads(tiles_pass_, 64 * tiles_.x, tiles_.y);
  recorder.bind(slabs_pass_,
                {gpu::read(frame), gpu::read(resources_.holes), gpu::read_write(resources_.lists)});
  recorder.dispatch_threads(slabs_pass_, shared::kHoleSlabs * kGroupsPerTile * tiles_.x,
                            kGroupsPerTile * tiles_.y);

  const shared::HoleCellsParams params{slot_count_, plan_.pair_capacity, plan_.block_capacity};
  recorder.bind(bricks_pass_,
                {gpu::read(frame), gpu::read(smoke.slot_bricks), gpu::read(resources_.holes),
                 gpu::read_write(resources_.cells), gpu::write(pairs_), gpu::read_write(counters_)},
                params);
  recorder.dispatch_threads(bricks_pass_, 64 * std::min(slot_count_, kRow), (slot_count_ + kRow - 1) / kRow);
  recorder.bind(cells_pass_,
                {gpu::read(frame), gpu::read(smoke.slot_bricks), gpu::read(resources_.holes),
                 gpu::read_write(resources_.cells), gpu::read(pairs_), gpu::read(counters_),
                 gpu::sampled(resources_.masks, nearest_)},
                params);
  recorder.dispatch_threads(cells_pass_, 64 * std::min(kGroups, plan_.pair_capacity));
}

}  // namespace brume::passes
