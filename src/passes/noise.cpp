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
  return gpu::Image(context, gpu::storage_image_3d(glm::uvec3(size), VK_FORMAT_R8G8B8A8_UNORM));
}

gpu::Image make_detail_tile(gpu::Context& context) {
  gpu::ImageInfo info = gpu::storage_image_3d(glm::uvec3(shared::kDetailTexels), VK_FORMAT_R8G8_UNORM,
                                              VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  info.mip_levels = static_cast<std::uint32_t>(std::bit_width(shared::kDetailTexels));
  return gpu::Image(context, info);
}

}  // namespace brume::passes
