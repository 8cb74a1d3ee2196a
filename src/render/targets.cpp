#include "render/targets.hpp"

#include "passes/raycast.hpp"

namespace brume::render {
namespace {

gpu::Image storage_image(gpu::Context& context, glm::uvec2 size, VkFormat format,
                         VkImageUsageFlags usage = 0) {
  gpu::ImageInfo info;
  info.format = format;
  info.size = {size, 1};
  info.usage =
      usage | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT;
  return gpu::Image(context, info);
}

}  // namespace

Targets::Targets(gpu::Context& context, glm::uvec2 size)
    : size_px(size),
      gbuffer(context, size),
      media(storage_image(context, size, VK_FORMAT_R16G16B16A16_SFLOAT, passes::kRaycastTargetUsage)),
      radiance(storage_image(context, size, VK_FORMAT_R16G16B16A16_SFLOAT,
                             VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT)),
      display(storage_image(context, size, VK_FORMAT_R8G8B8A8_UNORM)) {}

}  // namespace brume::render
