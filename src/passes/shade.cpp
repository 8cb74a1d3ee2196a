#include "passes/shade.hpp"

#include "brume_shaders.hpp"
#include "shared/decal.h"
#include "shared/display.h"
#include "shared/indirect_light.h"
#include "shared/noise.h"
#include "shared/resolve.h"

namespace brume::passes {

ShadePass::ShadePass(gpu::Context& context, bool cull_lights)
    : context_(context),
      cull_lights_(cull_lights ? 1 : 0),
      nearest_(context, {VK_FILTER_NEAREST}),
      linear_(context, {}),
      compare_(context, {VK_FILTER_LINEAR, VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE, false, true}) {}

void ShadePass::reserve(const Needs& needs) {
  const auto constant = [](bool value) { return value ? 1u : 0u; };
  pipelines_.try_emplace(needs, context_, shaders::shade_comp,
                         std::vector{cull_lights_, constant(needs.voxel_shadows), constant(needs.decals),
                                     constant(needs.display)});
}

void ShadePass::record(gpu::Recorder& recorder, const Needs& needs, const Inputs& in,
                       const Outputs& out) const {
  const gpu::ComputePipeline& pipeline = pipelines_.at(needs);
  // Without decals the shader does not read it, but a binding needs an image.
  const gpu::Image& occlusion = in.occlusion ? *in.occlusion : in.gbuffer.emission;
  recorder.bind(pipeline,
                {
                    {shared::kBindFrame, gpu::uniform(in.frame)},
                    {shared::kBindLights, gpu::read(in.scene.lights)},
                    {shared::kBindSun, gpu::uniform(in.shadows.sun)},
                    {shared::kBindShadowMaps, gpu::sampled(in.shadows.layers, compare_)},
                    {shared::kBindSunMap, gpu::sampled(in.shadows.sun_map, compare_)},
                    {shared::kBindAlbedoRoughness, gpu::sampled(in.gbuffer.albedo_roughness, nearest_)},
                    {shared::kBindNormalMetallic, gpu::sampled(in.gbuffer.normal_metallic, nearest_)},
                    {shared::kBindEmission, gpu::sampled(in.gbuffer.emission, nearest_)},
                    {shared::kBindDepth, gpu::sampled(in.gbuffer.depth, nearest_)},
                    {shared::kBindSmokeShadows, gpu::sampled(in.smoke_shadows.atlas, linear_)},
                    {shared::kBindSmoke, gpu::sampled(in.smoke, nearest_)},
                    {shared::kBindSkyLight, gpu::sampled(in.level.sky.light(), linear_)},
                    {shared::kBindIndirectCube, gpu::sampled(in.level.indirect_cube, linear_)},
                    {shared::kBindSolidTexels, gpu::sampled(in.level.solid.texels(), linear_)},
                    {shared::kBindSmokeShadowFaces, gpu::read(in.smoke_shadows.faces)},
                    {shared::kBindOcclusion, gpu::sampled(occlusion, nearest_)},
                    {shared::kBindBlueNoise, gpu::sampled(in.blue_noise, nearest_)},
                    {shared::kBindRadiance, gpu::stored(out.radiance)},
                    {shared::kBindDisplay, gpu::stored(out.display)},
                });
  recorder.dispatch_threads(pipeline, out.radiance.info().size.x, out.radiance.info().size.y);
}

}  // namespace brume::passes
