#include "passes/resolve.hpp"

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

}  // namespace

MarchBlocks::MarchBlocks(gpu::Context& context, glm::uvec2 size_px, std::uint32_t scale)
    : ends(
          context,
          [&] {
            const glm::uvec2 blocks = shared::blocks_of(size_px, scale);
            return VkDeviceSize{sizeof(shared::RayEnds)} * blocks.x * blocks.y;
          }(),
          VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT),
      near(block_image(context, shared::blocks_of(size_px, scale))),
      far(block_image(context, shared::blocks_of(size_px, scale))) {}

ResolvePass::ResolvePass(gpu::Context& context)
    : ends_(context, shaders::ray_ends_comp, {gpu::kBuffer, gpu::kSampled, gpu::kBuffer}, 0, {8, 8, 1}),
      resolve_(context, shaders::resolve_comp,
               {gpu::kBuffer, gpu::kSampled, gpu::kBuffer, gpu::kSampled, gpu::kSampled, gpu::kStored}, 0,
               {8, 8, 1}),
      nearest_(context, {VK_FILTER_NEAREST}) {}

void ResolvePass::record_ends(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& depth,
                              const MarchBlocks& blocks) const {
  recorder.bind(ends_, {gpu::read(frame), gpu::sampled(depth, nearest_), gpu::write(blocks.ends)});
  recorder.dispatch_threads(ends_, blocks.far.info().size.x, blocks.far.info().size.y);
}

void ResolvePass::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& depth,
                         const MarchBlocks& blocks, const gpu::Image& smoke) const {
  recorder.bind(resolve_, {gpu::read(frame), gpu::sampled(depth, nearest_), gpu::read(blocks.ends),
                           gpu::sampled(blocks.near, nearest_), gpu::sampled(blocks.far, nearest_),
                           gpu::stored(smoke)});
  recorder.dispatch_threads(resolve_, smoke.info().size.x, smoke.info().size.y);
}

}  // namespace brume::passes
