#include "passes/smoke_light.hpp"

#include <algorithm>

#include "brume_shaders.hpp"
#include "shared/indirect_light.h"
#include "shared/light_side.h"

namespace brume::passes {
namespace {

/// What the pipelines of rays differ by.
constexpr std::uint32_t kRayMedia = shared::kMediaOfDepths;

/// Workgroups of y and z for a list.
struct Groups {
  std::uint32_t y, z;
};
Groups groups_of(std::uint32_t count) {
  return {std::min(count, shared::kLightGroups), (count + shared::kLightGroups - 1) / shared::kLightGroups};
}

template <typename T>
void upload_list(gpu::Recorder& recorder, const gpu::Buffer& buffer, const std::vector<T>& list) {
  if (!list.empty()) recorder.upload(buffer, 0, std::as_bytes(std::span(list)));
}

shared::SmokeLightParams params_of(const volume::IndexRange& range, std::uint32_t threads) {
  return {range.first, range.count, threads};
}

}  // namespace

SmokeLightPass::SmokeLightPass(gpu::Context& context)
    : context_(context),
      texels_pass_(context, shaders::light_texels_comp),
      inscatter_pass_(context, shaders::inscatter_comp),
      linear_(context, {}),
      compare_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, false, true}) {
  trim();
}

void SmokeLightPass::trim() {
  gpu::shrink(context_, {&texel_lists_, &ray_pages_, &listed_bricks_, &changes_, &shadow_rays_, &gathers_,
                         &gathered_lights_});
}

planning::SmokeLightRoom SmokeLightPass::room() const {
  const auto items = [](const gpu::Buffer& buffer, std::size_t words) {
    return static_cast<std::uint32_t>(buffer.size() / (words * sizeof(std::uint32_t)));
  };
  return {items(texel_lists_, shared::kTexelListWords), items(ray_pages_, shared::kTexelsPerBrick)};
}

void SmokeLightPass::reserve_pipelines(std::uint32_t casters) {
  if (!rays_passes_.contains(casters & kRayMedia))
    rays_passes_.try_emplace(casters & kRayMedia, context_, shaders::light_rays_comp,
                             std::vector{casters & kRayMedia});
}

void SmokeLightPass::reserve(const planning::SmokeLightPlan& plan, std::uint32_t casters) {
  if (!plan.shadow_rays.empty()) reserve_pipelines(casters);
  // What is cached: twice what the plan needs, since a larger buffer loses it.
  const auto grow = [&](gpu::Buffer& buffer, std::size_t words) {
    const std::size_t bytes = words * sizeof(std::uint32_t), most = context_.limits().maxStorageBufferRange;
    if (buffer.size() < bytes) gpu::grow(context_, buffer, std::min(2 * bytes, std::max(most, bytes)));
  };
  grow(texel_lists_, std::size_t{plan.texel_list_count} * shared::kTexelListWords);
  grow(ray_pages_, std::size_t{plan.page_count} * shared::kTexelsPerBrick);

  // The plan's own lists.
  gpu::grow(context_, listed_bricks_, plan.texel_lists.size() * sizeof(shared::TexelList));
  gpu::grow(context_, changes_, plan.changes.size() * sizeof(shared::LightChange));
  gpu::grow(context_, shadow_rays_, plan.shadow_rays.size() * sizeof(shared::ShadowRays));
  gpu::grow(context_, gathers_, plan.gathers.size() * sizeof(shared::LightGather));
  gpu::grow(context_, gathered_lights_, plan.gathered_lights.size() * sizeof(glm::uvec2));
}

void SmokeLightPass::upload(gpu::Recorder& recorder, const planning::SmokeLightPlan& plan) {
  upload_list(recorder, listed_bricks_, plan.texel_lists);
  upload_list(recorder, changes_, plan.changes);
  upload_list(recorder, shadow_rays_, plan.shadow_rays);
  upload_list(recorder, gathers_, plan.gathers);
  upload_list(recorder, gathered_lights_, plan.gathered_lights);
}

template <typename Dispatch>
void SmokeLightPass::for_slices(const Part& part, const volume::IndexRange& range, std::uint32_t sliced,
                                std::uint32_t group, const Dispatch& dispatch) const {
  // One thread per texel, or one group for all of them.
  const auto threads_for = [&](std::uint32_t texels) {
    return context_.tuning().light_in_one_group ? group : (texels + group - 1) / group * group;
  };
  const std::uint32_t whole = range.count - sliced;
  if (whole > 0) dispatch({range.first, whole}, threads_for(shared::kTexelsPerBrick));
  if (sliced > 0) dispatch({range.first + whole, sliced}, threads_for(part.phases * shared::kTexelsPerPhase));
}

void SmokeLightPass::record_rays(gpu::Recorder& recorder, const Inputs& in, const Part& part) const {
  if (part.shadow_rays.count == 0) return;
  for_slices(part, part.shadow_rays, part.sliced_rays, rays_pass(in).group()[0],
             [&](const volume::IndexRange& range, std::uint32_t threads) {
               dispatch_rays(recorder, in, range, threads);
             });
}

void SmokeLightPass::record_gathers(gpu::Recorder& recorder, const Inputs& in, const Part& part) const {
  for_slices(part, part.gathers, part.sliced_gathers, inscatter_pass_.group()[0],
             [&](const volume::IndexRange& range, std::uint32_t threads) {
               dispatch_gathers(recorder, in, range, threads);
             });
}

void SmokeLightPass::record_texel_lists(gpu::Recorder& recorder, const Inputs& in, const Part& part) const {
  const volume::IndexRange& range = part.texel_lists;
  if (range.count == 0) return;
  recorder.bind(texels_pass_, {in.media.bindings()},
                {
                    {shared::kBindFrame, gpu::uniform(in.frame)},
                    {shared::kBindTexelLists, gpu::read(listed_bricks_)},
                    {shared::kBindLightRows, gpu::read_write(texel_lists_)},
                    {shared::kBindInscatter, gpu::stored(in.media.smoke.inscatter)},
                    {shared::kBindLightSide, gpu::stored(in.media.smoke.light_side)},
                    {shared::kBindLightChanges, gpu::read(changes_)},
                },
                params_of(range, texels_pass_.group()[0]));
  const Groups groups = groups_of(range.count);
  recorder.dispatch_threads(texels_pass_, texels_pass_.group()[0] * groups.y, groups.z);
}

const gpu::ComputePipeline& SmokeLightPass::rays_pass(const Inputs& in) const {
  return rays_passes_.at(in.media.set & kRayMedia);
}

void SmokeLightPass::dispatch_rays(gpu::Recorder& recorder, const Inputs& in, const volume::IndexRange& range,
                                   std::uint32_t threads) const {
  recorder.bind(rays_pass(in), {in.media.bindings()},
                {
                    {shared::kBindFrame, gpu::uniform(in.frame)},
                    {shared::kBindLights, gpu::read(in.scene.lights)},
                    {shared::kBindSun, gpu::uniform(in.shadows.sun)},
                    {shared::kBindShadowMaps, gpu::sampled(in.shadows.layers, compare_)},
                    {shared::kBindSunMap, gpu::sampled(in.shadows.sun_map, compare_)},
                    {shared::kBindSolidTexels, gpu::sampled(in.level.solid.texels(), linear_)},
                    {shared::kBindShadowRays, gpu::read(shadow_rays_)},
                    {shared::kBindLightRows, gpu::read(texel_lists_)},
                    {shared::kBindLightBlocks, gpu::write(ray_pages_)},
                },
                params_of(range, threads));
  const Groups groups = groups_of(range.count);
  recorder.dispatch_threads(rays_pass(in), threads, groups.y, groups.z);
}

void SmokeLightPass::dispatch_gathers(gpu::Recorder& recorder, const Inputs& in,
                                      const volume::IndexRange& range, std::uint32_t threads) const {
  recorder.bind(inscatter_pass_, {in.media.bindings()},
                {
                    {shared::kBindFrame, gpu::uniform(in.frame)},
                    {shared::kBindLights, gpu::read(in.scene.lights)},
                    {shared::kBindLightRows, gpu::read(texel_lists_)},
                    {shared::kBindLightBlocks, gpu::read(ray_pages_)},
                    {shared::kBindLightGathers, gpu::read(gathers_)},
                    {shared::kBindInscatter, gpu::stored(in.media.smoke.inscatter)},
                    {shared::kBindLightSide, gpu::stored(in.media.smoke.light_side)},
                    {shared::kBindIndirectCube, gpu::sampled(in.level.indirect_cube, linear_)},
                    {shared::kBindSkyLight, gpu::sampled(in.level.sky.light(), linear_)},
                    {shared::kBindSolidTexels, gpu::sampled(in.level.solid.texels(), linear_)},
                    {shared::kBindBrickLights, gpu::read(gathered_lights_)},
                },
                params_of(range, threads));
  const Groups groups = groups_of(range.count);
  recorder.dispatch_threads(inscatter_pass_, threads, groups.y, groups.z);
}

}  // namespace brume::passes
