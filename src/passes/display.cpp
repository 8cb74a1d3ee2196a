#include "passes/display.hpp"

#include "brume_shaders.hpp"

namespace brume::passes {

DisplayPass::DisplayPass(gpu::Context& context)
    : pipeline_(context, shaders::display_comp, {gpu::kUniform, gpu::kSampled, gpu::kStored, gpu::kStored}, 0,
                {8, 8, 1}),
      nearest_(context, {VK_FILTER_NEAREST}) {}

void DisplayPass::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& blue_noise,
                         const gpu::Image& picture, const gpu::Image& display) const {
  recorder.bind(pipeline_, {gpu::uniform(frame), gpu::sampled(blue_noise, nearest_),
                            gpu::read_stored(picture), gpu::stored(display)});
  recorder.dispatch_threads(pipeline_, display.info().size.x, display.info().size.y);
}

}  // namespace brume::passes
