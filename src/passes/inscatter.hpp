// Light from every lamp at every texel of the smoke's bricks.
#pragma once

#include "passes/shadow.hpp"
#include "passes/smoke_upload.hpp"
#include "shared/inscatter.h"

namespace brume::passes {

class InscatterPass {
 public:
  explicit InscatterPass(gpu::Context& context);
  /// Fills smoke.inscatter for all slots.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SceneResources& scene,
              const ShadowMaps& shadows, const SmokeResources& smoke, const gpu::Image& noise) const;

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Sampler linear_, repeat_, compare_;
};

}  // namespace brume::passes
