#include "passes/hole_grid.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "brume_shaders.hpp"

namespace brume::passes {
namespace {

constexpr double kCellsPerVoxel = shared::kHoleCellsPerVoxel;
constexpr double kMaxCellsPerHole = 1 << 17;
// 64 MiB of entries and 64 MiB of cells: below what every device takes in one buffer.
constexpr double kMaxEntries = 1 << 23;
constexpr double kMaxPairs = 1 << 20;
constexpr std::uint32_t kMaxBlocks = 2040;
constexpr std::uint32_t kWordsPerBlock = 2 * shared::kHoleCellsPerBlock;
// Workgroups that share the work of a pass, however much it turns out to be.
constexpr std::uint32_t kGroups = 2048;

/// How many cells and bricks a hole can reach: those whose centres lie within its capsule grown by half their
/// diagonal, all of which lie in the capsule grown by a whole one.
struct Reach {
  double cells, bricks;
};

double cubes_in_capsule(double length, double radius, double edge) {
  const double r = radius + std::numbers::sqrt3 * edge;
  return std::numbers::pi * r * r * (length + 4.0 / 3 * r) / (edge * edge * edge) + 1;
}

Reach reach_of(const shared::Hole& hole, float rim, float voxel_size) {
  const double corner = hole.shape == shared::kHoleCylinder ? 1 : std::numbers::sqrt2;
  const double radius = corner * static_cast<double>(hole.radius + rim) / static_cast<double>(voxel_size);
  const double length = static_cast<double>(hole.distance_to_far) / static_cast<double>(voxel_size);
  return {cubes_in_capsule(length, radius, 1 / kCellsPerVoxel),
          cubes_in_capsule(length, radius, shared::kBrickVoxels)};
}

bool is_open(const shared::Hole& hole, float time) {
  constexpr float kSlack = 1e-3f;  // [s]
  const float age = time - hole.time_start;
  return age > 0 && age < hole.time_to_reach_far + hole.time_to_expand + hole.time_to_stay_open +
                              hole.time_to_fade + kSlack;
}

/// Makes the buffer at least this large, in powers of two so that growth is rare.
void grow(gpu::Context& context, gpu::Buffer& buffer, std::size_t bytes) {
  if (buffer && buffer.size() >= bytes) return;
  buffer = gpu::Buffer(context, std::bit_ceil(std::max<std::size_t>(bytes, 256)),
                       VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
}

}  // namespace

HolePlan plan_holes(std::span<const shared::Hole> holes, float time, float rim, float voxel_size,
                    std::uint32_t slot_count, bool all_wide) {
  HolePlan plan;
  for (const shared::Hole& hole : holes)
    if (is_open(hole, time)) plan.holes.push_back(hole);
  std::stable_sort(plan.holes.begin(), plan.holes.end(),
                   [](const shared::Hole& a, const shared::Hole& b) { return a.radius > b.radius; });
  const auto count = static_cast<std::uint32_t>(plan.holes.size());
  if (all_wide) {
    plan.wide_count = count;
    return plan;
  }
  // From the smallest on, while there is room.
  double cells = 0, pairs = 0;
  std::uint32_t listed = 0;
  for (; listed < count; ++listed) {
    const Reach reach = reach_of(plan.holes[count - 1 - listed], rim, voxel_size);
    const double bricks = std::min(reach.bricks, static_cast<double>(slot_count));
    if (reach.cells > kMaxCellsPerHole || cells + reach.cells > kMaxEntries || pairs + bricks > kMaxPairs)
      break;
    cells += reach.cells;
    pairs += bricks;
  }
  plan.wide_count = count - listed;
  plan.entry_capacity = static_cast<std::uint32_t>(std::ceil(cells));
  plan.pair_capacity = static_cast<std::uint32_t>(std::ceil(pairs));
  plan.block_capacity = std::min({slot_count, plan.pair_capacity, kMaxBlocks});
  return plan;
}

HoleGrid::HoleGrid(gpu::Context& context, gpu::CommandRunner& runner, const sim::MaskAtlas& masks,
                   bool all_wide)
    : context_(context),
      all_wide_(all_wide),
      bricks_(context, shaders::hole_bricks_comp,
              {gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer},
              sizeof(shared::HoleGridParams), {64, 1, 1}),
      count_(context, shaders::hole_cells_comp,
             {gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer},
             sizeof(shared::HoleGridParams), {64, 1, 1}, {0}),
      places_(context, shaders::hole_places_comp, {gpu::kBuffer, gpu::kBuffer, gpu::kBuffer},
              sizeof(shared::HoleGridParams), {64, 1, 1}),
      write_(context, shaders::hole_cells_comp,
             {gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer},
             sizeof(shared::HoleGridParams), {64, 1, 1}, {1}),
      order_(context, shaders::hole_order_comp, {gpu::kBuffer, gpu::kBuffer, gpu::kBuffer},
             sizeof(shared::HoleGridParams), {64, 1, 1}),
      counters_(context, sizeof(shared::HoleGridCounters),
                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  reserve({}, 0, 0, 1, 0);
  runner.run([&](gpu::Recorder& recorder) { resources_.masks = make_hole_masks(context, recorder, masks); });
}

void HoleGrid::reserve(std::span<const shared::Hole> holes, float time, float rim, float voxel_size,
                       std::uint32_t slot_count) {
  plan_ = plan_holes(holes, time, rim, voxel_size, slot_count, all_wide_);
  slot_count_ = slot_count;
  grow(context_, resources_.holes, plan_.holes.size() * sizeof(shared::Hole));
  grow(context_, resources_.grid,
       (std::size_t{slot_count} + std::size_t{plan_.block_capacity} * kWordsPerBlock + plan_.entry_capacity) *
           sizeof(std::uint32_t));
  grow(context_, pairs_, plan_.pair_capacity * sizeof(glm::uvec2));
}

shared::HoleGridFrame HoleGrid::frame() const {
  return {static_cast<std::uint32_t>(plan_.holes.size()), plan_.wide_count, slot_count_,
          slot_count_ + plan_.block_capacity * kWordsPerBlock};
}

void HoleGrid::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SmokeResources& smoke) {
  recorder.upload(resources_.holes, 0, std::as_bytes(std::span(plan_.holes)));
  if (plan_.wide_count == plan_.holes.size() || slot_count_ == 0) return;
  const shared::HoleGridParams params{slot_count_, plan_.pair_capacity, plan_.block_capacity};
  const auto enter = [&](const gpu::ComputePipeline& pipeline) {
    recorder.bind(pipeline,
                  {gpu::read(frame), gpu::read(smoke.slot_bricks), gpu::read(resources_.holes),
                   gpu::read_write(resources_.grid), gpu::read_write(pairs_), gpu::read_write(counters_)},
                  params);
  };
  const auto walk_cells = [&](const gpu::ComputePipeline& pipeline) {
    recorder.bind(pipeline, {gpu::read(frame), gpu::read_write(resources_.grid), gpu::read_write(counters_)},
                  params);
    recorder.dispatch_threads(pipeline, 64 * std::min(kGroups, plan_.block_capacity * 64));
  };
  recorder.fill(counters_, 0);
  enter(bricks_);
  constexpr std::uint32_t kRow = 32768;  // every device takes 65,535 workgroups along an axis
  recorder.dispatch_threads(bricks_, 64 * std::min(slot_count_, kRow), (slot_count_ + kRow - 1) / kRow);
  const std::uint32_t pair_groups = std::min(kGroups * 4, plan_.pair_capacity);
  enter(count_);
  recorder.dispatch_threads(count_, 64 * pair_groups);
  walk_cells(places_);
  enter(write_);
  recorder.dispatch_threads(write_, 64 * pair_groups);
  walk_cells(order_);
}

}  // namespace brume::passes
