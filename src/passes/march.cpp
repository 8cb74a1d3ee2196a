#include "passes/march.hpp"

#include "brume_shaders.hpp"

namespace brume::passes {

namespace {

gpu::Image block_image(gpu::Context& context, glm::uvec2 blocks) {
  gpu::ImageInfo info;
  info.format = VK_FORMAT_R16G16B16A16_SFLOAT;
  info.size = {blocks, 1};
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  return gpu::Image(context, info);
}

gpu::Buffer block_buffer(gpu::Context& context, glm::uvec2 blocks, std::size_t head, std::size_t per_block) {
  return {context, head + per_block * blocks.x * blocks.y,
          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT |
              VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT};
}

gpu::ComputePipeline pipeline(gpu::Context& context, const MarchPass::Options& options, std::uint32_t rays,
                              std::uint32_t holes) {
  return {context,
          shaders::march_comp,
          {gpu::kUniform, gpu::kBuffer, gpu::kSampled, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer,
           gpu::kSampled, gpu::kSampled, gpu::kSampled, gpu::kSampled, gpu::kBuffer, gpu::kStored,
           gpu::kBuffer, gpu::kBuffer, gpu::kStored, gpu::kSampled, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer},
          0,
          {8, 8, 1},
          {options.count_steps     ? shared::kCountSteps
           : options.count_samples ? shared::kCountSamples
                                   : shared::kCountNothing,
           rays, holes}};
}

/// For frames without holes, and for those with.
std::array<gpu::ComputePipeline, 2> pipelines(gpu::Context& context, const MarchPass::Options& options,
                                              std::uint32_t rays) {
  return {
      pipeline(context, options, rays, shared::kHolesNone),
      pipeline(context, options, rays, options.brute_force_holes ? shared::kHolesAllTested : shared::kHolesClustered)};
}

}  // namespace

MarchTiles::MarchTiles(gpu::Context& context, glm::uvec2 size_px, std::uint32_t scale)
    : ends(block_buffer(context, shared::blocks_of(size_px, scale), 0, sizeof(shared::RayEnds))),
      near(block_image(context, shared::blocks_of(size_px, scale))),
      far(block_image(context, shared::blocks_of(size_px, scale))),
      list(block_buffer(context, shared::blocks_of(size_px, scale), sizeof(shared::MarchList),
                        sizeof(std::uint32_t))) {}

MarchPass::MarchPass(gpu::Context& context, const Options& options)
    : pixels_(pipelines(context, options, shared::kRaysOfPixels)),
      blocks_(pipelines(context, options, shared::kRaysOfTiles)),
      list_(pipelines(context, options, shared::kRaysOfList)),
      linear_(context, {}),
      repeat_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT}),
      nearest_(context, {VK_FILTER_NEAREST}) {}

void MarchPass::record(gpu::Recorder& recorder, const Inputs& in, const gpu::Image& smoke,
                       const gpu::Buffer& counters) const {
  const auto& pipeline = pixels_[in.holes.any ? 1 : 0];
  bind(recorder, pipeline, in, {in.frame, in.frame, smoke, smoke}, counters);
  recorder.dispatch_threads(pipeline, smoke.info().size.x, smoke.info().size.y);
}

void MarchPass::record_tiles(gpu::Recorder& recorder, const Inputs& in, const MarchTiles& blocks,
                              const gpu::Buffer& counters) const {
  const auto& pipeline = blocks_[in.holes.any ? 1 : 0];
  bind(recorder, pipeline, in, {blocks.ends, in.frame, blocks.near, blocks.far}, counters);
  recorder.dispatch_threads(pipeline, blocks.far.info().size.x, blocks.far.info().size.y);
}

void MarchPass::record_list(gpu::Recorder& recorder, const Inputs& in, const MarchTiles& blocks,
                            const gpu::Image& smoke, const gpu::Buffer& counters) const {
  bind(recorder, list_[in.holes.any ? 1 : 0], in, {in.frame, blocks.list, smoke, smoke}, counters);
  recorder.dispatch_indirect(blocks.list);
}

void MarchPass::bind(gpu::Recorder& recorder, const gpu::ComputePipeline& pipeline, const Inputs& in,
                     const Rays& rays, const gpu::Buffer& counters) const {
  recorder.bind(pipeline,
                {gpu::uniform(in.frame), gpu::read(in.smoke.pages), gpu::sampled(in.smoke.density_displacement, linear_),
                 gpu::read(in.smoke.cells), gpu::read(in.smoke.boundary), gpu::read(in.smoke.corners),
                 gpu::sampled(in.smoke.inscatter, linear_), gpu::sampled(in.noise, repeat_),
                 gpu::sampled(in.depth, nearest_), gpu::sampled(in.blue_noise, nearest_),
                 gpu::read(in.holes.holes), gpu::stored(rays.smoke), gpu::read_write(counters),
                 gpu::read(rays.ends), gpu::stored(rays.near), gpu::sampled(in.holes.masks, nearest_),
                 gpu::read(in.holes.lists), gpu::read(rays.list), gpu::read(in.smoke.filled)});
}

}  // namespace brume::passes
