#include "apps/viewer/upscale_pass.hpp"

#include "brume_shaders.hpp"
#include "shared/upscale.h"

namespace brume::viewer {

UpscalePass::UpscalePass(gpu::Context& context)
    : pipeline_(context, shaders::upscale_comp), nearest_(context, {VK_FILTER_NEAREST}) {}

void UpscalePass::record(gpu::Recorder& recorder, const gpu::Image& source, const gpu::Image& target) const {
  const shared::UpscaleConstants constants{glm::uvec2(source.info().size), glm::uvec2(target.info().size)};
  recorder.bind(pipeline_,
                {{shared::kBindUpscaleSource, gpu::sampled(source, nearest_)},
                 {shared::kBindUpscaleTarget, gpu::stored(target)}},
                constants);
  recorder.dispatch_threads(pipeline_, constants.target_px.x, constants.target_px.y);
}

}  // namespace brume::viewer
