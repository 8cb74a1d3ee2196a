// Light of all lights and of the sky at every texel of the smoke's bricks that may be visible
// (shared/smoke_light.h).
#pragma once

#include "passes/hole_clusters.hpp"
#include "passes/shade.hpp"
#include "passes/shadow.hpp"
#include "planning/smoke_light_cache.hpp"
#include "passes/smoke_upload.hpp"

namespace brume::passes {

class SmokeLightPass {
 public:
  explicit SmokeLightPass(gpu::Context& context);

  struct Inputs {
    const gpu::Buffer& frame;
    const SceneResources& scene;
    const ShadowMaps& shadows;
    const SmokeResources& smoke;
    const HoleResources& holes;
    LevelLight level;
  };
  /// Plans a frame, which must then be recorded, and makes room. Not between the begin and the end of a
  /// recording, and only when the device is done with what it recorded before. Throws resource_limit.
  void reserve(const planning::SmokeLightInputs& inputs);
  /// Brings smoke.inscatter to the inputs of `reserve`, where a ray of the frame's camera can meet smoke.
  void record(gpu::Recorder& recorder, const Inputs& inputs);

  /// What the next record does, or the last one did.
  const planning::SmokeLightPlan& plan() const { return *plan_; }

 private:
  void record_part(gpu::Recorder& recorder, const Inputs& inputs, const planning::SmokeLightPlan::Part& part);

  gpu::Context& context_;
  gpu::ComputePipeline texels_pass_, rays_pass_, inscatter_pass_;
  const bool one_group_;  // of threads for each entry of a list
  gpu::Sampler linear_, compare_;
  planning::SmokeLightCache kept_;
  const planning::SmokeLightPlan* plan_;
  gpu::Buffer rows_, blocks_;                                         // what is kept
  gpu::Buffer listed_rows_, changes_, pairs_, bricks_, brick_lights_;  // the lists of a plan
};

}  // namespace brume::passes
