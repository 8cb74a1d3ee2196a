#include "passes/volume_light.hpp"

#include "brume_shaders.hpp"
#include "shared/glow_field.h"
#include "shared/indirect_light.h"

namespace brume::passes {
namespace {

/// What the pipelines differ by.
constexpr std::uint32_t kSweepMedia = shared::kMediaOfDepths | shared::kMediumSeveral;
constexpr std::uint32_t kLightMedia =
    shared::kMediaOfAlbedos | shared::kMediaPresent | shared::kMediumSeveral | shared::kMediumDense;

/// `count` cubes along z, `side_by_side` of them along x.
gpu::Image cubes(gpu::Context& context, VkFormat format, std::uint32_t edge, std::uint32_t count,
                 std::uint32_t side_by_side) {
  return gpu::Image(context, gpu::storage_image_3d({edge * side_by_side, edge, edge * count}, format,
                                                   VK_IMAGE_USAGE_TRANSFER_DST_BIT));
}

}  // namespace

VolumeLightPass::VolumeLightPass(gpu::Context& context)
    : context_(context),
      linear_(context, {}),
      compare_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, false, true}),
      sun_depths_(cubes(context, VK_FORMAT_R16_SFLOAT, 1, 1, 1)),
      light_(cubes(context, VK_FORMAT_R16G16B16A16_SFLOAT, 1, 1, 1)) {}

planning::VolumeLightRoom VolumeLightPass::room() const {
  const std::uint32_t edge = light_.info().size.y;
  return {edge, sun_depths_.info().size.y, light_.info().size.z / edge, 0};
}

void VolumeLightPass::reserve(const planning::VolumeLightPlan& plan, std::uint32_t casters) {
  if (plan.sweeps.empty()) return;
  const auto count = static_cast<std::uint32_t>(plan.sweeps.size()) / shared::kSweepsOfVolume;
  const std::uint32_t sweep = casters & kSweepMedia, light = casters & kLightMedia;
  if (!sweep_pipelines_.contains(sweep))
    sweep_pipelines_.try_emplace(sweep, context_, shaders::volume_sweep_comp, std::vector{sweep});
  if (!light_pipelines_.contains(light))
    light_pipelines_.try_emplace(light, context_, shaders::volume_light_comp, std::vector{light});
  gpu::grow(context_, sweeps_, plan.sweeps.size() * sizeof(shared::VolumeSweep));
  const auto fits = [count](const gpu::Image& image, std::uint32_t edge) {
    return image.info().size.y == edge && image.info().size.z >= edge * count;
  };
  if (fits(light_, plan.edge) && fits(sun_depths_, plan.sun_edge)) return;
  // All of them or none: where memory was refused, another try makes all.
  gpu::Image lit = cubes(context_, VK_FORMAT_R16G16B16A16_SFLOAT, plan.edge, count, 1);
  gpu::Image sun_depths = cubes(context_, VK_FORMAT_R16_SFLOAT, plan.sun_edge, count, 1);
  sky_depths_ = cubes(context_, VK_FORMAT_R16_SFLOAT, shared::kSkyEdge, count, shared::kSkySweeps);
  light_ = std::move(lit);
  sun_depths_ = std::move(sun_depths);
}

void VolumeLightPass::record_sweeps(gpu::Recorder& recorder, const Inputs& in,
                                    const planning::VolumeLightPlan& plan) {
  if (!plan.update || plan.sweeps.empty()) return;
  const auto count = static_cast<std::uint32_t>(plan.sweeps.size()) / shared::kSweepsOfVolume;
  recorder.upload(sweeps_, 0, std::as_bytes(std::span(plan.sweeps)));
  const std::uint32_t is_alone = plan.is_alone ? 1 : 0;
  const shared::VolumeLightParams sun{plan.sun_edge, 0, 1, plan.sun, is_alone};
  const shared::VolumeLightParams sky{shared::kSkyEdge, 1, shared::kSkySweeps, plan.sun, is_alone};
  record_sweep(recorder, in, sun, sun_depths_, count);
  record_sweep(recorder, in, sky, sky_depths_, count * shared::kSkySweeps);
}

void VolumeLightPass::record_light(gpu::Recorder& recorder, const Inputs& in,
                                   const planning::VolumeLightPlan& plan) {
  if (!plan.update || plan.sweeps.empty()) return;
  const auto count = static_cast<std::uint32_t>(plan.sweeps.size()) / shared::kSweepsOfVolume;
  const shared::VolumeLightParams light{plan.edge, 0, 1, plan.sun, plan.is_alone ? 1u : 0u};
  const gpu::ComputePipeline& light_pipeline = light_pipelines_.at(in.media.set & kLightMedia);
  recorder.bind(light_pipeline, {in.media.bindings()},
                {
                    {shared::kBindFrame, gpu::uniform(in.frame)},
                    {shared::kBindLights, gpu::read(in.scene.lights)},
                    {shared::kBindSun, gpu::uniform(in.shadows.sun)},
                    {shared::kBindShadowMaps, gpu::sampled(in.shadows.layers, compare_)},
                    {shared::kBindSunMap, gpu::sampled(in.shadows.sun_map, compare_)},
                    {shared::kBindSolidTexels, gpu::sampled(in.level.solid.texels(), linear_)},
                    {shared::kBindIndirectCube, gpu::sampled(in.level.indirect_cube, linear_)},
                    {shared::kBindSkyLight, gpu::sampled(in.level.sky.light(), linear_)},
                    {shared::kBindSweeps, gpu::read(sweeps_)},
                    {shared::kBindSunDepths, gpu::sampled(sun_depths_, linear_)},
                    {shared::kBindSkyDepths, gpu::sampled(sky_depths_, linear_)},
                    {shared::kBindGlowField, gpu::sampled(in.glow_field, linear_)},
                    {shared::kBindVolumeLightTarget, gpu::stored(light_)},
                },
                light);
  recorder.dispatch_threads(light_pipeline, plan.edge, plan.edge, plan.edge * count);
}

void VolumeLightPass::record_sweep(gpu::Recorder& recorder, const Inputs& in,
                                   const shared::VolumeLightParams& params, const gpu::Image& depths,
                                   std::uint32_t sweeps) {
  const gpu::ComputePipeline& pipeline = sweep_pipelines_.at(in.media.set & kSweepMedia);
  recorder.bind(pipeline, {in.media.bindings()},
                {
                    {shared::kBindFrame, gpu::uniform(in.frame)},
                    {shared::kBindSweeps, gpu::read(sweeps_)},
                    {shared::kBindDepths, gpu::stored(depths)},
                },
                params);
  recorder.dispatch_threads(pipeline, params.edge, params.edge, sweeps);
}

}  // namespace brume::passes
