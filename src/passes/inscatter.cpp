#include "passes/inscatter.hpp"

#include <algorithm>

#include "brume_shaders.hpp"

namespace brume::passes {
namespace {

constexpr std::uint32_t kGroup = 64;
constexpr std::uint32_t kVolumeSteps = 24;
// Slots a dispatch: well below the 65,535 workgroups that every device takes.
constexpr std::uint32_t kSlotsPerDispatch = 4096;

}  // namespace

InscatterPass::InscatterPass(gpu::Context& context)
    : pipeline_(context, shaders::inscatter_comp,
                {gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kSampled, gpu::kBuffer, gpu::kSampled,
                 gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kBuffer, gpu::kStored, gpu::kSampled},
                sizeof(shared::InscatterParams), {kGroup, 1, 1}),
      linear_(context, {}),
      repeat_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_REPEAT}),
      compare_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, false, true}) {}

void InscatterPass::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SceneResources& scene,
                           const ShadowMaps& shadows, const SmokeResources& smoke,
                           const gpu::Image& noise) const {
  for (std::uint32_t first = 0; first < smoke.slot_count; first += kSlotsPerDispatch) {
    const std::uint32_t count = std::min(kSlotsPerDispatch, smoke.slot_count - first);
    recorder.bind(
        pipeline_,
        {gpu::read(frame), gpu::read(scene.lights), gpu::read(shadows.sun),
         gpu::sampled(shadows.layers, compare_), gpu::read(smoke.pages), gpu::sampled(smoke.density, linear_),
         gpu::read(smoke.cells), gpu::read(smoke.boundary), gpu::read(smoke.corners),
         gpu::read(smoke.slot_bricks), gpu::stored(smoke.inscatter), gpu::sampled(noise, repeat_)},
        shared::InscatterParams{first, count, kVolumeSteps});
    recorder.dispatch_threads(pipeline_, count * shared::kTexelsPerBrick);
  }
}

}  // namespace brume::passes
