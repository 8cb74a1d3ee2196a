#include "passes/hole_masks.hpp"

namespace brume::passes {

gpu::Image make_hole_masks(gpu::Context& context, gpu::Recorder& recorder, const smoke::MaskAtlas& masks) {
  gpu::ImageInfo info;
  info.format = VK_FORMAT_R8_UNORM;
  info.size = {masks.width(), masks.height(), 1};
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  gpu::Image image(context, info);
  const gpu::Recorder::Region all{std::as_bytes(masks.texels()), glm::ivec3(0), info.size};
  recorder.upload(image, {&all, 1});
  return image;
}

}  // namespace brume::passes
