// Shades the G-buffer and composites the smoke over it.
#pragma once

#include <optional>

#include "passes/gbuffer.hpp"
#include "passes/shadow.hpp"
#include "passes/sky_light.hpp"
#include "passes/smoke_shadow.hpp"

namespace brume::passes {

/// Light and occlusion by the level.
struct LevelLight {
  const SolidVolume& solid;
  const SkyLightPass& sky;
  const gpu::Image& indirect_cube;  ///< IndirectLightPass::cube.
};

class ShadePass {
 public:
  /// `cull_lights` false: every light at every pixel. The same image, slower.
  explicit ShadePass(gpu::Context& context, bool cull_lights = true);
  /// radiance = smoke radiance + smoke transmittance * radiance of the surface or the sky, half floats.
  /// `smoke`: premultiplied radiance and transmittance, of the image's size. Pixels behind
  /// smoke of transmittance 0 are not shaded. `smoke_shadows` comes from SmokeShadowPass. `voxel_shadows`:
  /// whether any light may be shadowed by voxels (kShadowByVoxels); false is faster.
  /// `occlusion`: what fraction of its light each surface loses, in red (DecalPass), after reserve_decals;
  /// null: none.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SceneResources& scene,
              const ShadowMaps& shadows, const SmokeShadows& smoke_shadows, const LevelLight& level,
              const GBuffer& gbuffer, const gpu::Image& smoke, const gpu::Image& radiance,
              bool voxel_shadows = true, const gpu::Image* occlusion = nullptr) const;
  /// Prepares for frames with decals. Outside of a recording.
  void reserve_decals();

 private:
  const gpu::ComputePipeline& pipeline(bool voxel_shadows, bool decals) const;

  gpu::Context& context_;
  std::uint32_t cull_lights_;
  gpu::ComputePipeline mapped_, mapped_and_voxels_;  // by the shadows that lights have
  std::optional<gpu::ComputePipeline> decals_, decals_and_voxels_;
  gpu::Sampler nearest_, linear_, compare_;
};

}  // namespace brume::passes
