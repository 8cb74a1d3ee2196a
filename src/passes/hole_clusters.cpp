#include "passes/hole_clusters.hpp"

#include <algorithm>

#include "brume_shaders.hpp"

namespace brume::passes {
namespace {

// Workgroups of a pass whose amount of work only the device knows.
constexpr std::uint32_t kGroups = 8192;
constexpr std::uint32_t kRow = 32768;  // every device takes 65,535 workgroups along an axis

}  // namespace

HoleClusters::HoleClusters(gpu::Context& context, gpu::CommandRunner& runner, const smoke::MaskAtlas& masks)
    : context_(context),
      tiles_pass_(context, shaders::hole_coarse_tiles_comp, {gpu::kUniform, gpu::kBuffer, gpu::kBuffer}, 0,
                  {256, 1, 1}),
      groups_pass_(context, shaders::hole_clusters_comp,
                   {gpu::kUniform, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer},
                   sizeof(shared::HoleListsParams), {128, 1, 1}),
      bricks_pass_(context, shaders::hole_bricks_comp,
                   {gpu::kUniform, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer},
                   sizeof(shared::HoleCellsParams), {64, 1, 1}),
      cells_pass_(context, shaders::hole_cells_comp,
                  {gpu::kUniform, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer,
                   gpu::kSampled},
                  sizeof(shared::HoleCellsParams), {64, 1, 1}),
      nearest_(context, {VK_FILTER_NEAREST}),
      counters_(context, sizeof(shared::HoleCounters),
                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      words_taken_(context, sizeof(std::uint32_t),
                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  reserve(planning::plan_holes({}, 0, 0, {}, 0, {1, 1}));
  set_masks(context, runner, masks);
}

void HoleClusters::set_masks(gpu::Context& context, gpu::CommandRunner& runner,
                             const smoke::MaskAtlas& masks) {
  runner.run([&](gpu::Recorder& recorder) { resources_.masks = make_hole_masks(context, recorder, masks); });
}

void HoleClusters::reserve(const planning::HolePlan& plan) {
  constexpr std::size_t kWord = sizeof(std::uint32_t);
  const std::size_t count = plan.holes.size(), words = (count + 31) / 32;
  const std::size_t tiles = std::size_t{plan.coarse_tiles.x} * plan.coarse_tiles.y;
  const std::size_t cells = std::size_t{plan.chunk_capacity} * shared::kHoleCellsPerChunk;
  resources_.any = count > 0;
  gpu::grow(context_, resources_.holes, count * (sizeof(shared::Hole) + sizeof(shared::HoleReach)));
  gpu::grow(context_, coarse_tile_holes_, tiles * words * kWord);
  gpu::grow(context_, resources_.lists, (std::size_t{plan.cluster_count} + plan.word_capacity) * kWord);
  gpu::grow(context_, resources_.cells, (plan.slot_count + cells) * kWord);
  gpu::grow(context_, pairs_, plan.pair_capacity * sizeof(glm::uvec2));
}

void HoleClusters::record(gpu::Recorder& recorder, const planning::HolePlan& plan, const gpu::Buffer& frame,
                          const SmokeResources& smoke) {
  if (plan.holes.empty()) return;
  recorder.fill(counters_, 0);
  recorder.fill(words_taken_, 0);
  const auto rows = planning::pack_holes(plan);
  recorder.upload(resources_.holes, 0, std::as_bytes(std::span(rows)));
  const shared::HoleListsParams lists{plan.word_capacity};
  const shared::HoleCellsParams cells{plan.slot_count, plan.pair_capacity, plan.chunk_capacity};
  const auto bytes = [](const auto& params) { return std::as_bytes(std::span(&params, 1)); };
  constexpr std::uint32_t kPerTile = shared::kCoarseTileTiles / 2;  // workgroups, along an axis
  // Clusters, which pixels read, and cells, which light reads, do not depend on each other.
  recorder.dispatch_together(
      {{tiles_pass_,
        {gpu::uniform(frame), gpu::read(resources_.holes), gpu::write(coarse_tile_holes_)},
        {tiles_pass_.group()[0] * plan.coarse_tiles.x, plan.coarse_tiles.y, 1}},
       {bricks_pass_,
        {gpu::uniform(frame), gpu::read(smoke.slot_bricks), gpu::read(resources_.holes),
         gpu::read_write(resources_.cells), gpu::write(pairs_), gpu::read_write(counters_)},
        {64 * std::min(plan.slot_count, kRow), (plan.slot_count + kRow - 1) / kRow, 1},
        bytes(cells)}});
  recorder.dispatch_together(
      {{groups_pass_,
        {gpu::uniform(frame), gpu::read(resources_.holes), gpu::read(coarse_tile_holes_),
         gpu::write(resources_.lists), gpu::read_write(words_taken_)},
        {groups_pass_.group()[0] * kPerTile * plan.coarse_tiles.x, kPerTile * plan.coarse_tiles.y, 1},
        bytes(lists)},
       {cells_pass_,
        {gpu::uniform(frame), gpu::read(smoke.slot_bricks), gpu::read(resources_.holes),
         gpu::read_write(resources_.cells), gpu::read(pairs_), gpu::read(counters_),
         gpu::sampled(resources_.masks, nearest_)},
        {64 * std::min(kGroups, plan.pair_capacity), 1, 1},
        bytes(cells)}});
}

}  // namespace brume::passes
