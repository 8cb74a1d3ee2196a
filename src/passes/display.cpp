#include "passes/display.hpp"

#include "brume_shaders.hpp"
#include "shared/display.h"
#include "shared/frame.h"
#include "shared/noise.h"

namespace brume::passes {

DisplayPass::DisplayPass(gpu::Context& context)
    : pipeline_(context, shaders::display_comp), nearest_(context, {VK_FILTER_NEAREST}) {}

void DisplayPass::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& blue_noise,
                         const gpu::Image& radiance, const gpu::Image& display, float dither) const {
  recorder.bind(pipeline_,
                {
                    {shared::kBindFrame, gpu::uniform(frame)},
                    {shared::kBindBlueNoise, gpu::sampled(blue_noise, nearest_)},
                    {shared::kBindRadiance, gpu::read_stored(radiance)},
                    {shared::kBindDisplay, gpu::stored(display)},
                },
                shared::DisplayParams{dither});
  recorder.dispatch_threads(pipeline_, display.info().size.x, display.info().size.y);
}

}  // namespace brume::passes
