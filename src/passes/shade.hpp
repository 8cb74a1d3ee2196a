// Shades the G-buffer and composites the smoke over it.
#pragma once

#include <compare>
#include <map>

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
  /// What a frame needs; each thing that it does not is faster.
  struct Needs {
    bool voxel_shadows = true;  ///< A light may be shadowed by voxels (kShadowByVoxels).
    bool decals = false;        ///< Surfaces lose light by Inputs::occlusion.
    bool display = false;       ///< Nothing else changes the radiance before it is displayed: shown at once.
    auto operator<=>(const Needs&) const = default;
  };
  struct Inputs {
    const gpu::Buffer& frame;
    const SceneResources& scene;
    const ShadowMaps& shadows;
    const SmokeShadows& smoke_shadows;
    LevelLight level;
    const GBuffer& gbuffer;
    const gpu::Image& smoke;  ///< Premultiplied radiance and transmittance, of the image's size.
    const gpu::Image& blue_noise;
    const gpu::Image* occlusion = nullptr;  ///< Red: what fraction of its light a surface loses (DecalPass).
  };
  struct Outputs {
    const gpu::Image& radiance;  ///< Half floats.
    const gpu::Image& display;   ///< RGBA8, as DisplayPass writes it; by Needs.
  };

  /// `cull_lights` false: every light at every pixel. The same image, slower.
  explicit ShadePass(gpu::Context& context, bool cull_lights = true);
  /// Prepares for frames of these needs. Outside of a recording.
  void reserve(const Needs& needs);
  /// radiance = smoke radiance + smoke transmittance * radiance of the surface or the sky. Pixels behind
  /// smoke of transmittance 0 are not shaded. `needs` are reserved.
  void record(gpu::Recorder& recorder, const Needs& needs, const Inputs& in, const Outputs& out) const;

 private:
  gpu::Context& context_;
  std::uint32_t cull_lights_;
  std::map<Needs, gpu::ComputePipeline> pipelines_;
  gpu::Sampler nearest_, linear_, compare_;
};

}  // namespace brume::passes
