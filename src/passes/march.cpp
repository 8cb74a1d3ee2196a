#include "passes/march.hpp"

#include "brume_shaders.hpp"

namespace brume::passes {

MarchPass::MarchPass(gpu::Context& context, bool count_samples, std::uint32_t rays)
    : pipeline_(context, shaders::march_comp,
                {gpu::kBuffer, gpu::kBuffer, gpu::kSampled, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer,
                 gpu::kSampled, gpu::kSampled, gpu::kSampled, gpu::kSampled, gpu::kBuffer, gpu::kStored,
                 gpu::kBuffer, gpu::kBuffer, gpu::kStored, gpu::kSampled, gpu::kBuffer},
                0, {8, 8, 1}, {count_samples ? 1u : 0u, rays}),
      linear_(context, {}),
      repeat_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT}),
      nearest_(context, {VK_FILTER_NEAREST}) {}

void MarchPass::record(gpu::Recorder& recorder, const Inputs& in, const gpu::Image& smoke,
                       const gpu::Buffer& counters) const {
  record(recorder, in, in.frame, smoke, smoke,
         counters);  // no ends, nothing near: the shader touches neither
}

void MarchPass::record(gpu::Recorder& recorder, const Inputs& in, const Blocks& blocks,
                       const gpu::Buffer& counters) const {
  record(recorder, in, blocks.ends, blocks.near, blocks.far, counters);
}

void MarchPass::record(gpu::Recorder& recorder, const Inputs& in, const gpu::Buffer& ends,
                       const gpu::Image& near, const gpu::Image& far, const gpu::Buffer& counters) const {
  recorder.bind(pipeline_,
                {gpu::read(in.frame), gpu::read(in.smoke.pages), gpu::sampled(in.smoke.density, linear_),
                 gpu::read(in.smoke.cells), gpu::read(in.smoke.boundary), gpu::read(in.smoke.corners),
                 gpu::sampled(in.smoke.inscatter, linear_), gpu::sampled(in.noise, repeat_),
                 gpu::sampled(in.depth, nearest_), gpu::sampled(in.blue_noise, nearest_),
                 gpu::read(in.holes.holes), gpu::stored(far), gpu::read_write(counters), gpu::read(ends),
                 gpu::stored(near), gpu::sampled(in.holes.masks, nearest_), gpu::read(in.holes.grid)});
  recorder.dispatch_threads(pipeline_, far.info().size.x, far.info().size.y);
}

}  // namespace brume::passes
