// Shadows of smoke on surfaces.
#pragma once

#include "passes/hole_clusters.hpp"
#include "passes/shadow.hpp"
#include "planning/smoke_shadow_plan.hpp"
#include "passes/smoke_upload.hpp"
#include "passes/solid_volume.hpp"

namespace brume::passes {

/// See shared/smoke_shadow.h.
struct SmokeShadows {
  gpu::Image atlas;   ///< Half floats: transmittance.
  gpu::Buffer faces;  ///< SmokeShadowFace, kFacesPerLight for each light.
};

class SmokeShadowPass {
 public:
  explicit SmokeShadowPass(gpu::Context& context);
  /// For pictures of this size: a ray for eight pixels, at least 2^16 and at most 2^19 rays. Holds no smoke
  /// until the first record.
  SmokeShadows make_shadows(gpu::Context& context, glm::uvec2 picture_px, std::size_t max_lights) const;

  struct Inputs {
    const gpu::Buffer& frame;
    const SceneResources& scene;
    const ShadowMaps& shadows;
    const SolidVolume& solid;
    const SmokeResources& smoke;
    const HoleResources& holes;
  };
  /// Every `spread`th texel of each rectangle along both axes, from the texel `first` below `spread` on.
  struct Texels {
    std::uint32_t spread = 1;
    glm::uvec2 first{0};
  };
  /// Marches rays of a plan for the atlas; the plan's lights are those of the scene's buffer.
  void record(gpu::Recorder& recorder, const Inputs& inputs, const planning::SmokeShadowPlan& plan,
              const SmokeShadows& shadows, const Texels& texels) const;

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Sampler linear_, nearest_;
};

}  // namespace brume::passes
