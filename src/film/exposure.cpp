#include "film/exposure.hpp"

#include <algorithm>

#include "film/read_back.hpp"
#include "planning/exposure.hpp"

namespace brume::film {
float measure_exposure(gpu::Context& context, render::Renderer& renderer, planning::FrameInput input) {
  constexpr std::uint32_t kHeight = 72;
  const glm::uvec2 size = renderer.targets().size_px;
  const glm::uvec2 small(std::clamp(kHeight * size.x / size.y, 8u, 512u), kHeight);
  input.smoke.volume = nullptr;
  const gpu::Buffer radiance = gpu::readback_buffer(context, std::size_t{8} * small.x * small.y);
  renderer.resize(small);
  renderer.draw(input,
                [&](gpu::Recorder& recorder) { recorder.read_back(renderer.targets().radiance, radiance); });
  renderer.resize(size);
  return planning::exposure_of(unpack_halves(radiance));
}

}  // namespace brume::film
