#include "passes/shade.hpp"

#include "brume_shaders.hpp"
#include "shared/display.h"
#include "shared/resolve.h"

namespace brume::passes {

ShadePass::ShadePass(gpu::Context& context, bool cull_lights)
    : mapped_(context, shaders::shade_comp, {cull_lights ? 1u : 0u, 0u}),
      mapped_and_voxels_(context, shaders::shade_comp, {cull_lights ? 1u : 0u, 1u}),
      nearest_(context, {VK_FILTER_NEAREST}),
      linear_(context, {}),
      compare_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, false, true}) {}

void ShadePass::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SceneResources& scene,
                       const ShadowMaps& shadows, const SmokeShadows& smoke_shadows, const LevelLight& level,
                       const GBuffer& gbuffer, const gpu::Image& smoke, const gpu::Image& radiance,
                       bool voxel_shadows) const {
  const gpu::ComputePipeline& pipeline = voxel_shadows ? mapped_and_voxels_ : mapped_;
  recorder.bind(pipeline,
                {
                    {shared::kBindFrame, gpu::uniform(frame)},
                    {shared::kBindLights, gpu::read(scene.lights)},
                    {shared::kBindSun, gpu::uniform(shadows.sun)},
                    {shared::kBindShadowMaps, gpu::sampled(shadows.layers, compare_)},
                    {shared::kBindAlbedoRoughness, gpu::sampled(gbuffer.albedo_roughness, nearest_)},
                    {shared::kBindNormalMetallic, gpu::sampled(gbuffer.normal_metallic, nearest_)},
                    {shared::kBindEmission, gpu::sampled(gbuffer.emission, nearest_)},
                    {shared::kBindDepth, gpu::sampled(gbuffer.depth, nearest_)},
                    {shared::kBindSmokeShadows, gpu::sampled(smoke_shadows.atlas, linear_)},
                    {shared::kBindSmoke, gpu::sampled(smoke, nearest_)},
                    {shared::kBindSkyLight, gpu::sampled(level.sky.light(), linear_)},
                    {shared::kBindSolidTexels, gpu::sampled(level.solid.texels(), linear_)},
                    {shared::kBindSmokeShadowFaces, gpu::read(smoke_shadows.faces)},
                    {shared::kBindRadiance, gpu::stored(radiance)},
                });
  recorder.dispatch_threads(pipeline, radiance.info().size.x, radiance.info().size.y);
}

}  // namespace brume::passes
