#include "passes/hole_clusters.hpp"

#include <algorithm>

#include "brume_shaders.hpp"

namespace brume::passes {
namespace {

// Workgroups of a pass whose amount of work only the device knows.
constexpr std::uint32_t kGroups = 8192;
constexpr std::uint32_t kRow = 32768;  // every device takes 65,535 workgroups along an axis

}  // namespace

HoleClusters::HoleClusters(gpu::Context& context, gpu::CommandStream& stream, const smoke::MaskAtlas& masks)
    : context_(context),
      tiles_pass_(context, shaders::hole_coarse_tiles_comp),
      groups_pass_(context, shaders::hole_clusters_comp),
      bricks_pass_(context, shaders::hole_bricks_comp),
      cells_pass_(context, shaders::hole_cells_comp),
      nearest_(context, {VK_FILTER_NEAREST}),
      resources_{.nearest = nearest_},
      counters_(context, sizeof(shared::HoleCounters),
                VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT),
      words_taken_(context, sizeof(std::uint32_t),
                   VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  reserve(planning::plan_holes({}, 0, 0, {}, 0, {1, 1}));
  set_masks(context, stream, masks);
}

void HoleClusters::set_masks(gpu::Context& context, gpu::CommandStream& stream,
                             const smoke::MaskAtlas& masks) {
  stream.run([&](gpu::Recorder& recorder) { resources_.masks = make_hole_masks(context, recorder, masks); });
}

void HoleClusters::reserve(const planning::HolePlan& plan) {
  constexpr std::size_t kWord = sizeof(std::uint32_t);
  const std::size_t count = plan.holes.size(), words = (count + 31) / 32;
  const std::size_t tiles = std::size_t{plan.coarse_tiles.x} * plan.coarse_tiles.y;
  const std::size_t cells = std::size_t{plan.chunk_capacity} * shared::kHoleCellsPerChunk;
  resources_.any = count > 0;
  gpu::grow(context_, resources_.holes, count * sizeof(shared::PackedHole));
  gpu::grow(context_, resources_.reaches, count * sizeof(shared::PackedReach));
  gpu::grow(context_, coarse_tile_holes_, tiles * words * kWord);
  gpu::grow(context_, resources_.lists, (std::size_t{plan.cluster_count} + plan.word_capacity) * kWord);
  gpu::grow(context_, resources_.cells, (plan.slot_count + cells) * kWord);
  gpu::grow(context_, pairs_, plan.pair_capacity * sizeof(glm::uvec2));
}

void HoleClusters::upload(gpu::Recorder& recorder, const planning::HolePlan& plan) {
  if (plan.holes.empty()) return;
  recorder.fill(counters_, 0);
  recorder.fill(words_taken_, 0);
  const auto holes = planning::pack_holes(plan.holes, plan.time, &recorder.memory());
  const auto reaches = planning::pack_reaches(plan.reaches, &recorder.memory());
  recorder.upload(resources_.holes, 0, std::as_bytes(std::span(holes)));
  recorder.upload(resources_.reaches, 0, std::as_bytes(std::span(reaches)));
}

void HoleClusters::record(gpu::Recorder& recorder, const planning::HolePlan& plan, const gpu::Buffer& frame,
                          const SmokeResources& smoke) {
  upload(recorder, plan);
  recorder.concurrently([&] { record_first(recorder, plan, frame, smoke); });
  recorder.concurrently([&] { record_second(recorder, plan, frame, smoke); });
}

// Clusters, which pixels read, and cells, which light reads, do not depend on each other.

void HoleClusters::record_first(gpu::Recorder& recorder, const planning::HolePlan& plan,
                                const gpu::Buffer& frame, const SmokeResources& smoke) {
  if (plan.holes.empty()) return;
  recorder.bind(tiles_pass_, {resources_.bindings()},
                {{shared::kBindFrame, gpu::uniform(frame)},
                 {shared::kBindCoarseTileHoles, gpu::write(coarse_tile_holes_)}});
  recorder.dispatch_threads(tiles_pass_, tiles_pass_.group()[0] * plan.coarse_tiles.x, plan.coarse_tiles.y);
  recorder.bind(bricks_pass_, {smoke.bindings(), resources_.bindings()},
                {
                    {shared::kBindFrame, gpu::uniform(frame)},
                    {shared::kBindHoleCells, gpu::read_write(resources_.cells)},
                    {shared::kBindHolePairs, gpu::write(pairs_)},
                    {shared::kBindHoleCounters, gpu::read_write(counters_)},
                },
                shared::HoleCellsParams{plan.slot_count, plan.pair_capacity, plan.chunk_capacity});
  recorder.dispatch_threads(bricks_pass_, 64 * std::min(plan.slot_count, kRow),
                            (plan.slot_count + kRow - 1) / kRow);
}

void HoleClusters::record_second(gpu::Recorder& recorder, const planning::HolePlan& plan,
                                 const gpu::Buffer& frame, const SmokeResources& smoke) {
  if (plan.holes.empty()) return;
  constexpr std::uint32_t kPerTile = shared::kCoarseTileTiles / 2;  // workgroups, along an axis
  recorder.bind(groups_pass_, {resources_.bindings()},
                {
                    {shared::kBindFrame, gpu::uniform(frame)},
                    {shared::kBindCoarseTileHoles, gpu::read(coarse_tile_holes_)},
                    {shared::kBindHoleLists, gpu::write(resources_.lists)},
                    {shared::kBindHoleWordsTaken, gpu::read_write(words_taken_)},
                },
                shared::HoleListsParams{plan.word_capacity});
  recorder.dispatch_threads(groups_pass_, groups_pass_.group()[0] * kPerTile * plan.coarse_tiles.x,
                            kPerTile * plan.coarse_tiles.y);
  recorder.bind(cells_pass_, {smoke.bindings(), resources_.bindings()},
                {
                    {shared::kBindFrame, gpu::uniform(frame)},
                    {shared::kBindHoleCells, gpu::read_write(resources_.cells)},
                    {shared::kBindHolePairs, gpu::read(pairs_)},
                    {shared::kBindHoleCounters, gpu::read(counters_)},
                },
                shared::HoleCellsParams{plan.slot_count, plan.pair_capacity, plan.chunk_capacity});
  recorder.dispatch_threads(cells_pass_, 64 * std::min(kGroups, plan.pair_capacity));
}

}  // namespace brume::passes
