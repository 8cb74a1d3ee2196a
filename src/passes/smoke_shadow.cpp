#include "passes/smoke_shadow.hpp"

#include "brume_shaders.hpp"

namespace brume::passes {
namespace {

constexpr float kMaxSteps = 24;

/// Texels per edge: 200,000 rays for a few lights and for many alike.
std::uint32_t layer_size(std::uint32_t layers) {
  return layers <= 64 ? 64 : 32;
}

}  // namespace

SmokeShadowPass::SmokeShadowPass(gpu::Context& context)
    : pipeline_(context, shaders::smoke_shadow_comp,
                {gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kSampled, gpu::kBuffer, gpu::kSampled,
                 gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kSampled, gpu::kStored, gpu::kBuffer,
                 gpu::kBuffer, gpu::kSampled},
                sizeof(shared::SmokeShadowParams), {8, 8, 1}),
      linear_(context, {}),
      nearest_(context, {VK_FILTER_NEAREST}) {}

gpu::Image SmokeShadowPass::make_layers(gpu::Context& context, const ShadowMaps& shadows) const {
  gpu::ImageInfo info;
  info.format = VK_FORMAT_R16_SFLOAT;
  info.layers = shadows.layers.info().layers;
  info.size = {glm::uvec2(layer_size(info.layers)), 1};
  info.usage = VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  return gpu::Image(context, info);
}

void SmokeShadowPass::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SceneResources& scene,
                             const ShadowMaps& shadows, const SmokeResources& smoke,
                             const HoleResources& holes, const gpu::Image& layers) const {
  const std::uint32_t size = layers.info().size.x;
  recorder.bind(pipeline_,
                {gpu::read(frame), gpu::read(scene.lights), gpu::read(shadows.sun),
                 gpu::sampled(shadows.layers, nearest_), gpu::read(smoke.pages),
                 gpu::sampled(smoke.density, linear_), gpu::read(smoke.cells), gpu::read(smoke.boundary),
                 gpu::read(smoke.corners), gpu::sampled(smoke.drift, linear_), gpu::stored(layers),
                 gpu::read(holes.holes), gpu::read(holes.grid), gpu::sampled(holes.masks, nearest_)});
  // Each light writes layers of its own: no barrier between.
  for (std::uint32_t i = 0; i < scene.light_list.size(); ++i) {
    const shared::Light& light = scene.light_list[i];
    if (light.shadow_layer == shared::kNoShadow) continue;
    const shared::SmokeShadowParams params{i, size, kMaxSteps};
    recorder.push(pipeline_, std::as_bytes(std::span(&params, 1)));
    recorder.dispatch_threads(pipeline_, size, size, light.kind == shared::kLightDirectional ? 1 : 6);
  }
}

}  // namespace brume::passes
