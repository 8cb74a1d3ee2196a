#include "passes/shade.hpp"

#include "brume_shaders.hpp"

namespace brume::passes {

ShadePass::ShadePass(gpu::Context& context, bool cull_lights)
    : pipeline_(context, shaders::shade_comp,
                {gpu::kUniform, gpu::kBuffer, gpu::kBuffer, gpu::kSampled, gpu::kSampled, gpu::kSampled,
                 gpu::kSampled, gpu::kSampled, gpu::kSampled, gpu::kSampled, gpu::kSampled, gpu::kSampled,
                 gpu::kBuffer, gpu::kStored},
                0, {8, 8, 1}, {cull_lights ? 1u : 0u}),
      nearest_(context, {VK_FILTER_NEAREST}),
      linear_(context, {}),
      compare_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, false, true}) {}

void ShadePass::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SceneResources& scene,
                       const ShadowMaps& shadows, const SmokeShadows& smoke_shadows, const LevelLight& level,
                       const GBuffer& gbuffer, const gpu::Image& smoke, const gpu::Image& picture) const {
  recorder.bind(
      pipeline_,
      {gpu::uniform(frame), gpu::read(scene.lights), gpu::read(shadows.sun),
       gpu::sampled(shadows.layers, compare_), gpu::sampled(gbuffer.albedo_roughness, nearest_),
       gpu::sampled(gbuffer.normal_metallic, nearest_), gpu::sampled(gbuffer.emission, nearest_),
       gpu::sampled(gbuffer.depth, nearest_), gpu::sampled(smoke_shadows.atlas, linear_),
       gpu::sampled(smoke, nearest_), gpu::sampled(level.sky.light(), linear_),
       gpu::sampled(level.solid.texels(), linear_), gpu::read(smoke_shadows.faces), gpu::stored(picture)});
  recorder.dispatch_threads(pipeline_, picture.info().size.x, picture.info().size.y);
}

}  // namespace brume::passes
