// Half floats of images in tests.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <glm/gtc/packing.hpp>
#include <vector>

#include "gpu/recorder.hpp"
#include "shared/indirect_light.h"

namespace brume::passes {

using Half4 = std::array<std::uint16_t, 4>;

inline glm::vec4 from_half(const Half4& h) {
  return {glm::unpackHalf1x16(h[0]), glm::unpackHalf1x16(h[1]), glm::unpackHalf1x16(h[2]),
          glm::unpackHalf1x16(h[3])};
}
inline std::vector<glm::vec4> from_half(const std::vector<Half4>& texels) {
  std::vector<glm::vec4> values;
  for (const Half4& texel : texels) values.push_back(from_half(texel));
  return values;
}
inline Half4 to_half(glm::vec4 v) {
  return {glm::packHalf1x16(v.x), glm::packHalf1x16(v.y), glm::packHalf1x16(v.z), glm::packHalf1x16(v.w)};
}

/// An image that passes can read and write and tests can fill.
inline gpu::Image test_image(gpu::Context& context, glm::uvec2 size, VkFormat format) {
  gpu::ImageInfo info;
  info.format = format;
  info.size = {size, 1};
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT |
               VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  return gpu::Image(context, info);
}

/// Where there is no indirect light.
inline gpu::Image make_indirect_cube(gpu::Context& context) {
  gpu::ImageInfo info;
  info.format = VK_FORMAT_R16G16B16A16_SFLOAT;
  info.size = {1, 1, shared::kIndirectSlabs};
  info.three_dimensional = true;
  info.usage = VK_IMAGE_USAGE_SAMPLED_BIT;
  return gpu::Image(context, info);
}

template <typename T>
gpu::Image upload_image(gpu::Context& context, gpu::CommandRunner& runner, glm::uvec2 size, VkFormat format,
                        const std::vector<T>& texels) {
  gpu::Image image = test_image(context, size, format);
  const gpu::Recorder::Region all{std::as_bytes(std::span(texels)), glm::ivec3(0), {size, 1}};
  runner.run([&](gpu::Recorder& recorder) { recorder.upload(image, {&all, 1}); });
  return image;
}

}  // namespace brume::passes
