#include "passes/resolve.hpp"

#include "brume_shaders.hpp"

namespace brume::passes {
ResolvePass::ResolvePass(gpu::Context& context)
    : ends_(context, shaders::ray_ends_comp, {gpu::kUniform, gpu::kSampled, gpu::kBuffer}, 0, {8, 8, 1}),
      select_(context, shaders::march_select_comp,
              {gpu::kUniform, gpu::kBuffer, gpu::kSampled, gpu::kSampled, gpu::kSampled, gpu::kBuffer}, 0,
              {8, 8, 1}),
      resolve_(context, shaders::resolve_comp,
               {gpu::kUniform, gpu::kSampled, gpu::kBuffer, gpu::kSampled, gpu::kSampled, gpu::kStored}, 0,
               {8, 8, 1}),
      nearest_(context, {VK_FILTER_NEAREST}) {}

void ResolvePass::record_ends(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& depth,
                              const MarchTiles& blocks) const {
  recorder.bind(ends_, {gpu::uniform(frame), gpu::sampled(depth, nearest_), gpu::write(blocks.ends)});
  recorder.dispatch_threads(ends_, blocks.far.info().size.x, blocks.far.info().size.y);
}

void ResolvePass::record_select(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& emission,
                                const MarchTiles& blocks) const {
  const shared::MarchList empty{{0, 0, 1}, 0};
  recorder.upload(blocks.list, 0, std::as_bytes(std::span(&empty, 1)));
  recorder.bind(select_, {gpu::uniform(frame), gpu::read(blocks.ends), gpu::sampled(blocks.near, nearest_),
                          gpu::sampled(blocks.far, nearest_), gpu::sampled(emission, nearest_),
                          gpu::read_write(blocks.list)});
  recorder.dispatch_threads(select_, blocks.far.info().size.x, blocks.far.info().size.y);
}

void ResolvePass::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& depth,
                         const MarchTiles& blocks, const gpu::Image& smoke) const {
  recorder.bind(resolve_, {gpu::uniform(frame), gpu::sampled(depth, nearest_), gpu::read(blocks.ends),
                           gpu::sampled(blocks.near, nearest_), gpu::sampled(blocks.far, nearest_),
                           gpu::stored(smoke)});
  recorder.dispatch_threads(resolve_, smoke.info().size.x, smoke.info().size.y);
}

}  // namespace brume::passes
