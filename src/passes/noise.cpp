#include "passes/noise.hpp"

#include <bit>

#include "brume_shaders.hpp"

namespace brume::passes {

NoisePass::NoisePass(gpu::Context& context)
    : pipeline_(context, shaders::noise_comp),
      detail_pipeline_(context, shaders::noise_detail_comp),
      repeat_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT}) {}

void NoisePass::record(gpu::Recorder& recorder, const gpu::Image& tile,
                       const shared::NoiseParams& params) const {
  recorder.bind(pipeline_, {{shared::kBindNoiseTile, gpu::stored(tile)}}, params);
  recorder.dispatch_threads(pipeline_, params.size, params.size, params.size);
}

void NoisePass::record_detail(gpu::Recorder& recorder, const gpu::Image& tile,
                              const gpu::Image& detail) const {
  recorder.bind(detail_pipeline_, {{shared::kBindNoiseTile, gpu::sampled(tile, repeat_)},
                                   {shared::kBindDetailTile, gpu::stored(detail)}});
  constexpr std::uint32_t kEdge{shared::kDetailTexels};
  recorder.dispatch_threads(detail_pipeline_, kEdge, kEdge, kEdge);
  recorder.make_mip_levels(detail);
}

gpu::Image make_noise_tile(gpu::Context& context, std::uint32_t size) {
  gpu::ImageInfo info;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.size = glm::uvec3(size);
  info.three_dimensional = true;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  return gpu::Image(context, info);
}

gpu::Image make_detail_tile(gpu::Context& context) {
  gpu::ImageInfo info;
  info.format = VK_FORMAT_R8G8_UNORM;
  info.size = glm::uvec3(shared::kDetailTexels);
  info.three_dimensional = true;
  info.mip_levels = static_cast<std::uint32_t>(std::bit_width(shared::kDetailTexels));
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
               VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  return gpu::Image(context, info);
}

}  // namespace brume::passes
