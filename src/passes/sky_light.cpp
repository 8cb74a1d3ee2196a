#include "passes/sky_light.hpp"

#include "brume_shaders.hpp"
#include "shared/frame.h"

namespace brume::passes {

SkyLightPass::SkyLightPass(gpu::Context& context)
    : context_(context),
      rays_pipeline_(context, shaders::sky_rays_comp),
      light_pipeline_(context, shaders::sky_light_comp) {}

void SkyLightPass::reserve(const SolidVolume& solid) {
  const VkDeviceSize bytes =
      VkDeviceSize{shared::kSkyDirections} * solid.word_count() * sizeof(std::uint32_t);
  if (!rays_ || rays_.size() != bytes)
    rays_ =
        gpu::Buffer(context_, bytes, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_TRANSFER_SRC_BIT);
  const glm::uvec3 size(solid.layout().size);
  if (light_ && light_.info().size == size) return;
  light_ = gpu::Image(context_, gpu::storage_image_3d(size, VK_FORMAT_R16G16B16A16_SFLOAT));
}

void SkyLightPass::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SolidVolume& solid) const {
  recorder.bind(rays_pipeline_, {{shared::kBindFrame, gpu::uniform(frame)},
                                 {shared::kBindSolidWords, gpu::read(solid.words())},
                                 {shared::kBindSkyRays, gpu::write(rays_)}});
  recorder.dispatch_threads(rays_pipeline_, solid.word_count(), shared::kSkyDirections);
  recorder.bind(light_pipeline_, {{shared::kBindFrame, gpu::uniform(frame)},
                                  {shared::kBindSkyRays, gpu::read(rays_)},
                                  {shared::kBindSkyLight, gpu::stored(light_)}});
  const glm::uvec3 size = light_.info().size;
  recorder.dispatch_threads(light_pipeline_, size.x, size.y * size.z);
}

}  // namespace brume::passes
