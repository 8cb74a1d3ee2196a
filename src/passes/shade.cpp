#include "passes/shade.hpp"

#include "brume_shaders.hpp"
#include "shared/decal.h"
#include "shared/display.h"
#include "shared/indirect_light.h"
#include "shared/resolve.h"

namespace brume::passes {

ShadePass::ShadePass(gpu::Context& context, bool cull_lights)
    : context_(context),
      cull_lights_(cull_lights ? 1 : 0),
      mapped_(context, shaders::shade_comp, {cull_lights_, 0u, 0u}),
      mapped_and_voxels_(context, shaders::shade_comp, {cull_lights_, 1u, 0u}),
      nearest_(context, {VK_FILTER_NEAREST}),
      linear_(context, {}),
      compare_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, false, true}) {}

void ShadePass::reserve_decals() {
  if (decals_) return;
  decals_.emplace(context_, shaders::shade_comp, std::vector<std::uint32_t>{cull_lights_, 0u, 1u});
  decals_and_voxels_.emplace(context_, shaders::shade_comp, std::vector<std::uint32_t>{cull_lights_, 1u, 1u});
}

const gpu::ComputePipeline& ShadePass::pipeline(bool voxel_shadows, bool decals) const {
  if (decals) return voxel_shadows ? *decals_and_voxels_ : *decals_;
  return voxel_shadows ? mapped_and_voxels_ : mapped_;
}

void ShadePass::record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SceneResources& scene,
                       const ShadowMaps& shadows, const SmokeShadows& smoke_shadows, const LevelLight& level,
                       const GBuffer& gbuffer, const gpu::Image& smoke, const gpu::Image& radiance,
                       bool voxel_shadows, const gpu::Image* occlusion) const {
  const gpu::ComputePipeline& pipeline = this->pipeline(voxel_shadows, occlusion != nullptr);
  recorder.bind(
      pipeline,
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
          {shared::kBindIndirectCube, gpu::sampled(level.indirect_cube, linear_)},
          {shared::kBindSolidTexels, gpu::sampled(level.solid.texels(), linear_)},
          {shared::kBindSmokeShadowFaces, gpu::read(smoke_shadows.faces)},
          {shared::kBindOcclusion, gpu::sampled(occlusion ? *occlusion : gbuffer.emission, nearest_)},
          {shared::kBindRadiance, gpu::stored(radiance)},
      });
  recorder.dispatch_threads(pipeline, radiance.info().size.x, radiance.info().size.y);
}

}  // namespace brume::passes
