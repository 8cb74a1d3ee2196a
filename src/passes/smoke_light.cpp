#include "passes/smoke_light.hpp"

#include <algorithm>

#include "brume_shaders.hpp"

namespace brume::passes {
namespace {

constexpr std::uint32_t kThreads = 64;

/// Workgroups of y and z for a list.
struct Groups {
  std::uint32_t y, z;
};
Groups groups_of(std::uint32_t count) {
  return {std::min(count, shared::kLightGroups), (count + shared::kLightGroups - 1) / shared::kLightGroups};
}

template <typename T>
void upload(gpu::Recorder& recorder, const gpu::Buffer& buffer, const std::vector<T>& list) {
  if (!list.empty()) recorder.upload(buffer, 0, std::as_bytes(std::span(list)));
}

}  // namespace

SmokeLightPass::SmokeLightPass(gpu::Context& context)
    : context_(context),
      texels_pass_(context, shaders::light_texels_comp),
      rays_pass_(context, shaders::light_rays_comp),
      inscatter_pass_(context, shaders::inscatter_comp),
      one_group_(context.info().kind == "cpu"),
      linear_(context, {}),
      compare_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, false, true}),
      plan_(&kept_.plan({})) {
  for (gpu::Buffer* buffer : {&rows_, &blocks_, &listed_rows_, &changes_, &pairs_, &bricks_, &brick_lights_})
    gpu::grow(context, *buffer, 1);
}

void SmokeLightPass::reserve(const planning::SmokeLightInputs& inputs) {
  const auto make_room = [&] {
    constexpr std::size_t kWord = sizeof(std::uint32_t);
    const std::size_t most = context_.limits().maxStorageBufferRange;
    // Twice what is needed, so that it is seldom: what was kept is lost then.
    const auto grow = [&](gpu::Buffer& buffer, std::size_t bytes) {
      return buffer.size() < bytes && gpu::grow(context_, buffer, std::min(2 * bytes, std::max(most, bytes)));
    };
    const bool rows = grow(rows_, plan_->row_count * shared::kTexelListWords * kWord);
    const bool blocks = grow(blocks_, plan_->page_count * shared::kTexelsPerBrick * kWord);
    return rows || blocks;
  };
  plan_ = &kept_.plan(inputs);
  if (make_room()) {
    kept_.forget();
    plan_ = &kept_.plan(inputs);
  }
  gpu::grow(context_, listed_rows_, plan_->rows.size() * sizeof(shared::TexelList));
  gpu::grow(context_, changes_, plan_->changes.size() * sizeof(shared::LightChange));
  gpu::grow(context_, pairs_, plan_->pairs.size() * sizeof(shared::ShadowRays));
  gpu::grow(context_, bricks_, plan_->bricks.size() * sizeof(shared::LightGather));
  gpu::grow(context_, brick_lights_, plan_->lights.size() * sizeof(glm::uvec2));
}

void SmokeLightPass::record(gpu::Recorder& recorder, const Inputs& in) {
  upload(recorder, listed_rows_, plan_->rows);
  upload(recorder, changes_, plan_->changes);
  upload(recorder, pairs_, plan_->pairs);
  upload(recorder, bricks_, plan_->bricks);
  upload(recorder, brick_lights_, plan_->lights);
  for (const planning::SmokeLightPlan::Part& part : plan_->parts) record_part(recorder, in, part);
}

void SmokeLightPass::record_part(gpu::Recorder& recorder, const Inputs& in,
                                 const planning::SmokeLightPlan::Part& part) {
  const auto params = [](const volume::IndexRange& range, std::uint32_t threads) {
    return shared::SmokeLightParams{range.first, range.count, threads};
  };
  if (part.rows.count > 0) {
    recorder.bind(texels_pass_,
                  {
                      {shared::kBindFrame, gpu::uniform(in.frame)},
                      {shared::kBindTexelLists, gpu::read(listed_rows_)},
                      {shared::kBindDensity, gpu::sampled(in.smoke.density, linear_)},
                      {shared::kBindLightRows, gpu::read_write(rows_)},
                      {shared::kBindCells, gpu::read(in.smoke.cells)},
                      {shared::kBindSlotBricks, gpu::read(in.smoke.slot_bricks)},
                      {shared::kBindLightChanges, gpu::read(changes_)},
                  },
                  params(part.rows, 256));
    const Groups groups = groups_of(part.rows.count);
    recorder.dispatch_threads(texels_pass_, 256 * groups.y, groups.z);
  }
  // First what asks for texels of every phase, then what asks for those of some. A thread a texel; without a
  // GPU one group for all of them, since there threads that have none cost as much as those that have.
  const auto threads_for = [&](std::uint32_t texels) {
    return one_group_ ? kThreads : (texels + kThreads - 1) / kThreads * kThreads;
  };
  const auto each = [&](const volume::IndexRange& range, std::uint32_t few, auto record) {
    if (range.count > few) record({range.first, range.count - few}, threads_for(shared::kTexelsPerBrick));
    if (few > 0)
      record({range.first + range.count - few, few}, threads_for(part.phases * shared::kTexelsPerPhase));
  };
  each(part.pairs, part.few_pairs, [&](const volume::IndexRange& range, std::uint32_t threads) {
    recorder.bind(rays_pass_,
                  {
                      {shared::kBindFrame, gpu::uniform(in.frame)},
                      {shared::kBindSlotBricks, gpu::read(in.smoke.slot_bricks)},
                      {shared::kBindLights, gpu::read(in.scene.lights)},
                      {shared::kBindSun, gpu::read(in.shadows.sun)},
                      {shared::kBindShadowMaps, gpu::sampled(in.shadows.layers, compare_)},
                      {shared::kBindPages, gpu::read(in.smoke.pages)},
                      {shared::kBindFilteredDensity, gpu::sampled(in.smoke.filtered_density, linear_)},
                      {shared::kBindCells, gpu::read(in.smoke.cells)},
                      {shared::kBindBoundary, gpu::read(in.smoke.boundary)},
                      {shared::kBindCorners, gpu::read(in.smoke.corners)},
                      {shared::kBindHoleCells, gpu::read(in.holes.cells)},
                      {shared::kBindSolidTexels, gpu::sampled(in.level.solid.texels(), linear_)},
                      {shared::kBindShadowRays, gpu::read(pairs_)},
                      {shared::kBindLightRows, gpu::read(rows_)},
                      {shared::kBindLightBlocks, gpu::write(blocks_)},
                  },
                  params(range, threads));
    const Groups groups = groups_of(range.count);
    recorder.dispatch_threads(rays_pass_, threads, groups.y, groups.z);
  });
  each(part.bricks, part.few_bricks, [&](const volume::IndexRange& range, std::uint32_t threads) {
    recorder.bind(inscatter_pass_,
                  {
                      {shared::kBindFrame, gpu::uniform(in.frame)},
                      {shared::kBindSlotBricks, gpu::read(in.smoke.slot_bricks)},
                      {shared::kBindLights, gpu::read(in.scene.lights)},
                      {shared::kBindLightRows, gpu::read(rows_)},
                      {shared::kBindLightBlocks, gpu::read(blocks_)},
                      {shared::kBindLightGathers, gpu::read(bricks_)},
                      {shared::kBindInscatter, gpu::stored(in.smoke.inscatter)},
                      {shared::kBindSkyLight, gpu::sampled(in.level.sky.light(), linear_)},
                      {shared::kBindSolidTexels, gpu::sampled(in.level.solid.texels(), linear_)},
                      {shared::kBindFilteredDensity, gpu::sampled(in.smoke.filtered_density, linear_)},
                      {shared::kBindBrickLights, gpu::read(brick_lights_)},
                  },
                  params(range, threads));
    const Groups groups = groups_of(range.count);
    recorder.dispatch_threads(inscatter_pass_, threads, groups.y, groups.z);
  });
}

}  // namespace brume::passes
