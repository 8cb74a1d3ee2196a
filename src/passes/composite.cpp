#include "passes/composite.hpp"

#include "brume_shaders.hpp"

namespace brume::passes {

CompositePass::CompositePass(gpu::Context& context)
    : pipeline_(context, shaders::composite_comp, {gpu::kBuffer, gpu::kSampled, gpu::kStored, gpu::kStored},
                0, {8, 8, 1}),
      nearest_(context, {VK_FILTER_NEAREST}) {}

void CompositePass::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& smoke,
                           const gpu::Image& lit, const gpu::Image& picture) const {
  recorder.bind(pipeline_, {gpu::read(frame), gpu::sampled(smoke, nearest_), gpu::read_stored(lit),
                            gpu::stored(picture)});
  recorder.dispatch_threads(pipeline_, picture.info().size.x, picture.info().size.y);
}

}  // namespace brume::passes
