#include "passes/antialias.hpp"

#include "brume_shaders.hpp"
#include "shared/display.h"
#include "shared/gbuffer.h"
#include "shared/resolve.h"

namespace brume::passes {

AntialiasPass::AntialiasPass(gpu::Context& context, glm::uvec2 size_px)
    : context_(context),
      pipeline_(context, shaders::antialias_comp),
      nearest_(context, {VK_FILTER_NEAREST}),
      linear_(context, {}) {
  const gpu::ImageInfo info = gpu::storage_image(size_px, VK_FORMAT_R16G16B16A16_SFLOAT);
  for (gpu::Image& image : radiance_) image = gpu::Image(context, info);
}

void AntialiasPass::record(gpu::Recorder& recorder, const Inputs& in, const glm::mat4& clip_from_world,
                           glm::vec2 jitter, bool continues) {
  Past& past = recorder.change(past_);
  const std::size_t before = past.current, now = 1 - before;
  recorder.bind(pipeline_,
                {
                    {shared::kBindFrame, gpu::uniform(in.frame)},
                    {shared::kBindDepth, gpu::sampled(in.depth, nearest_)},
                    {shared::kBindSmoke, gpu::sampled(in.media, nearest_)},
                    {shared::kBindRadiance, gpu::sampled(in.radiance, nearest_)},
                    {shared::kBindPastRadiance, gpu::sampled(radiance_[before], linear_)},
                    {shared::kBindMeanRadiance, gpu::stored(radiance_[now])},
                },
                shared::AntialiasParams{past.clip_from_world, jitter, continues && past.is_valid ? 1u : 0u});
  recorder.dispatch_threads(pipeline_, in.radiance.info().size.x, in.radiance.info().size.y);
  past = {now, true, clip_from_world};
}

}  // namespace brume::passes
