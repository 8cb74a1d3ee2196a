#include "passes/smoke_shadow.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "brume_shaders.hpp"

namespace brume::passes {
namespace {

/// What the pipelines differ by.
constexpr std::uint32_t kShadowMedia = shared::kMediaOfDepths;
constexpr float kStepMetres = 0.25f;
constexpr std::uint32_t kRayThreads = 256;  // four for each ray of a block

}  // namespace

SmokeShadowPass::SmokeShadowPass(gpu::Context& context)
    : context_(context), nearest_(context, {VK_FILTER_NEAREST}) {}

void SmokeShadowPass::reserve(std::uint32_t casters) {
  const std::uint32_t media = casters & kShadowMedia;
  if (pipelines_.contains(media)) return;
  pipelines_.try_emplace(media, context_, shaders::smoke_shadow_comp, std::vector{media});
}

SmokeShadows SmokeShadowPass::make_shadows(gpu::Context& context, glm::uvec2 image_px,
                                           std::size_t max_lights) const {
  const std::uint64_t rays =
      std::clamp<std::uint64_t>(std::uint64_t{image_px.x} * image_px.y / 8, 1u << 16, 1u << 19);
  SmokeShadows shadows;
  // At most four times as wide as high, so that one large face fits.
  const std::uint32_t width = std::min(std::bit_ceil(static_cast<std::uint32_t>(2 * std::sqrt(rays))), 1024u);
  const gpu::ImageInfo info = gpu::storage_image({width, static_cast<std::uint32_t>(rays / width)},
                                                 VK_FORMAT_R16_SFLOAT, VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  shadows.atlas = gpu::Image(context, info);
  const std::size_t faces = std::max<std::size_t>(max_lights, 1) * shared::kFacesPerLight;
  shadows.faces = gpu::Buffer(context, faces * sizeof(shared::SmokeShadowFace),
                              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT);
  return shadows;
}

void SmokeShadowPass::upload(gpu::Recorder& recorder, const planning::SmokeShadowUpdate& update,
                             const SmokeShadows& shadows) {
  recorder.upload(shadows.faces, 0, std::as_bytes(std::span(update.plan.faces)));
}

void SmokeShadowPass::record(gpu::Recorder& recorder, const Inputs& in,
                             const planning::SmokeShadowUpdate& update, const SmokeShadows& shadows) const {
  const planning::SmokeShadowPlan& plan = update.plan;
  if (plan.blocks == 0) return;
  shared::SmokeShadowParams params{};
  params.face_count = static_cast<std::uint32_t>(plan.faces.size());
  params.step_length = kStepMetres;
  params.spread = update.spread;
  params.first = update.first;
  const gpu::ComputePipeline& pipeline = pipelines_.at(in.media.set & kShadowMedia);
  recorder.bind(pipeline, {in.media.bindings()},
                {
                    {shared::kBindFrame, gpu::uniform(in.frame)},
                    {shared::kBindLights, gpu::read(in.scene.lights)},
                    {shared::kBindSun, gpu::uniform(in.shadows.sun)},
                    {shared::kBindShadowMaps, gpu::sampled(in.shadows.layers, nearest_)},
                    {shared::kBindSunMap, gpu::sampled(in.shadows.sun_map, nearest_)},
                    {shared::kBindSmokeShadows, gpu::stored(shadows.atlas)},
                    {shared::kBindSmokeShadowFaces, gpu::read(shadows.faces)},
                    {shared::kBindSolidTexels, gpu::sampled(in.solid.texels(), nearest_)},
                },
                params);
  recorder.dispatch_threads(pipeline, kRayThreads * plan.blocks, 1);
}

}  // namespace brume::passes
