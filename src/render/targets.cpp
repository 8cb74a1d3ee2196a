#include "render/targets.hpp"

#include "passes/raycast.hpp"

namespace brume::render {
namespace {

gpu::Image media_image(gpu::Context& context, glm::uvec2 size) {
  return {context, gpu::storage_image(size, VK_FORMAT_R16G16B16A16_SFLOAT, passes::kRaycastTargetUsage)};
}

}  // namespace

Targets::Targets(gpu::Context& context, glm::uvec2 size)
    : size_px(size),
      gbuffer(context, size),
      media(media_image(context, size)),
      radiance(context,
               gpu::storage_image(size, VK_FORMAT_R16G16B16A16_SFLOAT,
                                  VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT)),
      display(context, gpu::storage_image(size, VK_FORMAT_R8G8B8A8_UNORM)) {}

Targets::Targets(glm::uvec2 size, passes::GBuffer&& surfaces, gpu::Image&& media_target)
    : size_px(size), gbuffer(std::move(surfaces)), media(std::move(media_target)) {}

Targets Targets::of_media(gpu::Context& context, glm::uvec2 size) {
  return {size, passes::GBuffer::imported(context, size), media_image(context, size)};
}

}  // namespace brume::render
