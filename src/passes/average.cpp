#include "passes/average.hpp"

#include "brume_shaders.hpp"
#include "shared/average.h"
#include "shared/display.h"

namespace brume::passes {

AveragePass::AveragePass(gpu::Context& context, glm::uvec2 size_px)
    : pipeline_(context, shaders::average_comp) {
  gpu::ImageInfo info;
  info.format = VK_FORMAT_R32G32B32A32_SFLOAT;
  info.size = {size_px, 1};
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT;
  sum_ = gpu::Image(context, info);
}

void AveragePass::record(gpu::Recorder& recorder, const gpu::Image& radiance, std::uint32_t index) const {
  const glm::uvec2 size_px(sum_.info().size);
  recorder.bind(pipeline_,
                {
                    {shared::kBindRadiance, gpu::read_write_stored(radiance)},
                    {shared::kBindRadianceSum, gpu::read_write_stored(sum_)},
                },
                shared::AverageConstants{size_px, index});
  recorder.dispatch_threads(pipeline_, size_px.x, size_px.y);
}

}  // namespace brume::passes
