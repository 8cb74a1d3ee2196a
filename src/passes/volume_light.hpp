// Light in the volumes besides the smoke: sweeps along the sun and the axes, then a cube of light per volume
// (shaders/shared/volume_light.h).
#pragma once

#include <map>

#include "passes/media_resources.hpp"
#include "passes/shade.hpp"
#include "planning/volume_light_plan.hpp"

namespace brume::passes {

class VolumeLightPass {
 public:
  struct Inputs {
    const gpu::Buffer& frame;  ///< FrameConstants.
    const SceneResources& scene;
    const ShadowMaps& shadows;
    const LevelLight& level;
    MediaResources media;          ///< As light meets them; `reserve` has seen their set.
    const gpu::Image& glow_field;  ///< GlowFieldPass::field, of the same volumes.
  };

  explicit VolumeLightPass(gpu::Context& context);
  /// The cubes of light that a plan may rely on; the cubes of glow are GlowFieldPass's.
  planning::VolumeLightRoom room() const;
  /// Makes room for the light of a plan: where it does not fit into room(), the light of earlier frames is
  /// lost. Outside of a recording, once the device has finished previous ones. Throws resource_limit.
  void reserve(const planning::VolumeLightPlan& plan, std::uint32_t casters);
  // Where the plan updates:
  /// The optical depths along the sun and the axes.
  void record_sweeps(gpu::Recorder& recorder, const Inputs& in, const planning::VolumeLightPlan& plan);
  /// The cubes of light, from these depths.
  void record_light(gpu::Recorder& recorder, const Inputs& in, const planning::VolumeLightPlan& plan);
  /// The cubes of all volumes in view.
  const gpu::Image& light() const { return light_; }
  const gpu::Image& sun_depths() const { return sun_depths_; }
  const gpu::Image& sky_depths() const { return sky_depths_; }

 private:
  void record_sweep(gpu::Recorder& recorder, const Inputs& in, const shared::VolumeLightParams& params,
                    const gpu::Image& depths, std::uint32_t sweeps);

  gpu::Context& context_;
  gpu::Sampler linear_, compare_;
  std::map<std::uint32_t, gpu::ComputePipeline> sweep_pipelines_, light_pipelines_;  ///< By media.
  gpu::Image sun_depths_, sky_depths_, light_;
  gpu::Buffer sweeps_;
};

}  // namespace brume::passes
