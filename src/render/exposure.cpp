#include "render/exposure.hpp"

#include <algorithm>
#include <cstring>
#include <glm/gtc/packing.hpp>

#include "planning/exposure.hpp"

namespace brume::render {
float measure_exposure(gpu::Context& context, Renderer& renderer, FrameInput input) {
  constexpr std::uint32_t kHeight = 72;
  const glm::uvec2 size = renderer.targets().size_px;
  const glm::uvec2 small(std::clamp(kHeight * size.x / size.y, 8u, 512u), kHeight);
  input.smoke.volume = nullptr;
  const std::size_t count = std::size_t{small.x} * small.y;
  const gpu::Buffer radiance(context, count * 8, VK_BUFFER_USAGE_TRANSFER_DST_BIT, gpu::MemoryUse::readback);
  renderer.resize(small);
  renderer.draw(input,
                [&](gpu::Recorder& recorder) { recorder.read_back(renderer.targets().radiance, radiance); });
  renderer.resize(size);

  std::vector<glm::vec4> pixels(count);
  for (std::size_t i = 0; i < count; ++i) {
    std::uint64_t half = 0;
    std::memcpy(&half, static_cast<const std::byte*>(radiance.mapped()) + 8 * i, 8);
    pixels[i] = glm::unpackHalf4x16(half);
  }
  return planning::exposure_of(pixels);
}

}  // namespace brume::render
