#include "passes/hole_masks.hpp"

namespace brume::passes {

gpu::Image make_hole_masks(gpu::Context& context, gpu::Recorder& recorder, const smoke::MaskAtlas& masks) {
  gpu::Image image(context, gpu::sampled_image({masks.width(), masks.height()}, VK_FORMAT_R8_UNORM));
  const gpu::Recorder::Region all{std::as_bytes(masks.texels()), glm::ivec3(0), image.info().size};
  recorder.upload(image, {&all, 1});
  return image;
}

}  // namespace brume::passes
