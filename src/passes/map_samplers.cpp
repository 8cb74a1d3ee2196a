#include "passes/map_samplers.hpp"

#include <array>

namespace brume::passes {
namespace {

/// By scene::Wrap.
constexpr std::array kAddressModes{VK_SAMPLER_ADDRESS_MODE_REPEAT, VK_SAMPLER_ADDRESS_MODE_MIRRORED_REPEAT,
                                   VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE};

}  // namespace

MapSamplers::MapSamplers(gpu::Context& context, float anisotropy) {
  for (const VkSamplerAddressMode v : kAddressModes)
    for (const VkSamplerAddressMode u : kAddressModes)
      samplers_.emplace_back(context, gpu::SamplerInfo{VK_FILTER_LINEAR, u, true, false, anisotropy, v});
}

gpu::Binding MapSamplers::sampled(const SceneResources& scene, std::uint32_t image) const {
  const auto [u, v] = scene.wraps[image];
  const std::size_t sampler =
      kAddressModes.size() * static_cast<std::size_t>(v) + static_cast<std::size_t>(u);
  return gpu::sampled(scene.images[image], samplers_[sampler]);
}

void MapSamplers::prepare_for_draws(gpu::Recorder& recorder, const SceneResources& scene) const {
  for (std::uint32_t i = 0; i < scene.images.size(); ++i) recorder.prepare_for_draws({sampled(scene, i)});
}

}  // namespace brume::passes
