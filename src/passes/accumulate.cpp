#include "passes/accumulate.hpp"

#include "brume_shaders.hpp"
#include "shared/gbuffer.h"
#include "shared/resolve.h"

namespace brume::passes {

AccumulatePass::AccumulatePass(gpu::Context& context, glm::uvec2 size_px)
    : context_(context),
      pipeline_(context, shaders::accumulate_comp),
      nearest_(context, {VK_FILTER_NEAREST}),
      linear_(context, {}) {
  const gpu::ImageInfo info =
      gpu::storage_image(size_px, VK_FORMAT_R16G16B16A16_SFLOAT, VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  const VkDeviceSize bytes = VkDeviceSize{sizeof(shared::AccumulatedPixel)} * size_px.x * size_px.y;
  for (std::size_t i = 0; i < 2; ++i) {
    smoke_[i] = gpu::Image(context, info);
    pixels_[i] = gpu::Buffer(context, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT);
  }
}

void AccumulatePass::record(gpu::Recorder& recorder, const gpu::Buffer& frame, glm::uvec2 size_px,
                            const gpu::Image& depth, const gpu::Image& smoke,
                            const std::optional<planning::PastView>& past) {
  Stored& stored = recorder.change(stored_);
  // Filters read beside a frame, with weights of 0.
  if (!stored.is_clear)
    for (const gpu::Image& image : smoke_) recorder.clear(image, {});
  const std::size_t before = stored.current, now = 1 - before;
  const planning::PastView from = past.value_or(planning::PastView());
  const shared::AccumulateParams params{from.seen_from_world, from.size_px,
                                        past && stored.is_valid ? 1u : 0u};
  recorder.bind(pipeline_,
                {
                    {shared::kBindFrame, gpu::uniform(frame)},
                    {shared::kBindDepth, gpu::sampled(depth, nearest_)},
                    {shared::kBindSmoke, gpu::sampled(smoke, nearest_)},
                    {shared::kBindPastSmoke, gpu::sampled(smoke_[before], linear_)},
                    {shared::kBindPastPixels, gpu::read(pixels_[before])},
                    {shared::kBindMeanSmoke, gpu::stored(smoke_[now])},
                    {shared::kBindMeanPixels, gpu::write(pixels_[now])},
                },
                params);
  recorder.dispatch_threads(pipeline_, size_px.x, size_px.y);
  stored = {now, true, true};
}

}  // namespace brume::passes
