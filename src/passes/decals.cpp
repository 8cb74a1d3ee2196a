#include "passes/decals.hpp"

#include "brume_shaders.hpp"
#include "shared/noise.h"

namespace brume::passes {

DecalPass::DecalPass(gpu::Context& context, glm::uvec2 size_px)
    : context_(context),
      pipeline_(context, shaders::decals_comp),
      nearest_(context, {VK_FILTER_NEAREST}),
      linear_(context, {}),
      decals_(context, shared::kMaxDecals * sizeof(shared::Decal),
              VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT) {
  const gpu::ImageInfo info =
      gpu::storage_image(size_px, VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  for (gpu::Image& image : occlusion_) image = gpu::Image(context, info);
}

void DecalPass::upload(gpu::Recorder& recorder, std::span<const shared::Decal> decals) {
  BRUME_ASSERT(decals.size() <= shared::kMaxDecals, std::to_string(decals.size()));
  decal_count_ = static_cast<std::uint32_t>(decals.size());
  if (!decals.empty()) recorder.upload(decals_, 0, std::as_bytes(decals));
}

void DecalPass::record(gpu::Recorder& recorder, const gpu::Buffer& frame, glm::uvec2 size_px,
                       const GBuffer& gbuffer, const gpu::Image& blue_noise, const gpu::Image& slices,
                       const std::optional<planning::PastView>& past) {
  Stored& stored = recorder.change(stored_);
  // Filters read beside a frame, with weights of 0.
  if (!stored.is_clear)
    for (const gpu::Image& image : occlusion_) recorder.clear(image, {});
  const std::size_t before = stored.current, now = 1 - before;
  const planning::PastView from = past.value_or(planning::PastView());
  const shared::DecalParams params{from.seen_from_world, from.size_px, past ? stored.frames : 0,
                                   decal_count_};
  recorder.bind(pipeline_,
                {
                    {shared::kBindFrame, gpu::uniform(frame)},
                    {shared::kBindDepth, gpu::sampled(gbuffer.depth, nearest_)},
                    {shared::kBindNormalMetallic, gpu::sampled(gbuffer.normal_metallic, nearest_)},
                    {shared::kBindBlueNoise, gpu::sampled(blue_noise, nearest_)},
                    {shared::kBindSliceTextures, gpu::sampled(slices, linear_)},
                    {shared::kBindDecals, gpu::read(decals_)},
                    {shared::kBindPastOcclusion, gpu::sampled(occlusion_[before], linear_)},
                    {shared::kBindOcclusion, gpu::stored(occlusion_[now])},
                },
                params);
  recorder.dispatch_threads(pipeline_, size_px.x, size_px.y);
  stored = {now, params.past_frames + 1, true};
}

}  // namespace brume::passes
