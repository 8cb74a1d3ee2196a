#include "film/read_back.hpp"

#include <algorithm>
#include <glm/gtc/packing.hpp>

namespace brume::film {

image::Image8 read_picture(const gpu::Buffer& pixels, glm::uvec2 size_px) {
  const auto bytes = gpu::values_of<std::uint8_t>(pixels);
  return {size_px.x, size_px.y, {bytes.begin(), bytes.end()}};
}

image::Image8 read_picture(gpu::Context& context, gpu::CommandRunner& runner, const gpu::Image& image,
                           const std::function<void(gpu::Recorder&)>& record) {
  return read_picture(gpu::read_back(context, runner, image, 4, record), glm::uvec2(image.info().size));
}

std::vector<glm::vec4> unpack_halves(const gpu::Buffer& pixels) {
  const auto packed = gpu::values_of<std::uint64_t>(pixels);
  std::vector<glm::vec4> values(packed.size());
  std::ranges::transform(packed, values.begin(),
                         [](std::uint64_t halves) { return glm::unpackHalf4x16(halves); });
  return values;
}

}  // namespace brume::film
