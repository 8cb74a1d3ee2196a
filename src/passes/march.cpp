#include "passes/march.hpp"

#include "brume_shaders.hpp"

namespace brume::passes {

MarchPass::MarchPass(gpu::Context& context, bool count_samples)
    : pipeline_(
          context, shaders::march_comp,
          {gpu::kBuffer, gpu::kBuffer, gpu::kSampled, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kSampled,
           gpu::kSampled, gpu::kSampled, gpu::kSampled, gpu::kBuffer, gpu::kStored, gpu::kBuffer},
          0, {8, 8, 1}, {count_samples ? 1u : 0u}),
      linear_(context, {}),
      repeat_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT}),
      nearest_(context, {VK_FILTER_NEAREST}) {}

void MarchPass::record(gpu::Recorder& recorder, const Inputs& in, const gpu::Image& smoke,
                       const gpu::Buffer& counters) const {
  recorder.bind(pipeline_,
                {gpu::read(in.frame), gpu::read(in.smoke.pages), gpu::sampled(in.smoke.density, linear_),
                 gpu::read(in.smoke.cells), gpu::read(in.smoke.boundary), gpu::read(in.smoke.corners),
                 gpu::sampled(in.smoke.inscatter, linear_), gpu::sampled(in.worley, repeat_),
                 gpu::sampled(in.depth, nearest_), gpu::sampled(in.blue_noise, nearest_), gpu::read(in.holes),
                 gpu::stored(smoke), gpu::read_write(counters)});
  recorder.dispatch_threads(pipeline_, smoke.info().size.x, smoke.info().size.y);
}

}  // namespace brume::passes
