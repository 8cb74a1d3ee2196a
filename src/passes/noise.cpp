#include "passes/noise.hpp"

#include "brume_shaders.hpp"

namespace brume::passes {

NoisePass::NoisePass(gpu::Context& context) : pipeline_(context, shaders::noise_comp) {}

void NoisePass::record(gpu::Recorder& recorder, const gpu::Image& tile,
                       const shared::NoiseParams& params) const {
  recorder.bind(pipeline_, {{shared::kBindNoiseTile, gpu::stored(tile)}}, params);
  recorder.dispatch_threads(pipeline_, params.size, params.size, params.size);
}

gpu::Image make_noise_tile(gpu::Context& context, std::uint32_t size) {
  gpu::ImageInfo info;
  info.format = VK_FORMAT_R8G8B8A8_UNORM;
  info.size = glm::uvec3(size);
  info.three_dimensional = true;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  return gpu::Image(context, info);
}

}  // namespace brume::passes
