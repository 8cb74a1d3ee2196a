#include "passes/layers.hpp"

#include "brume_shaders.hpp"
#include "shared/layers.h"

namespace brume::passes {

LayerPass::LayerPass(gpu::Context& context)
    : pipeline_(context, shaders::layer_over_comp), nearest_(context, {VK_FILTER_NEAREST}) {}

void LayerPass::begin(gpu::Recorder& recorder, const gpu::Image& layers) const {
  recorder.clear(layers, {.float32 = {0, 0, 0, 1}});
}

void LayerPass::add(gpu::Recorder& recorder, const gpu::Image& over, const gpu::Image& layers) const {
  recorder.bind(pipeline_, {{shared::kBindOverLayer, gpu::sampled(over, nearest_)},
                            {shared::kBindUnderLayers, gpu::read_write_stored(layers)}});
  recorder.dispatch_threads(pipeline_, layers.info().size.x, layers.info().size.y);
}

}  // namespace brume::passes
