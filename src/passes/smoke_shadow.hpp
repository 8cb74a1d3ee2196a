// How much the smoke dims what each light sends to the surfaces.
#pragma once

#include "passes/hole_grid.hpp"
#include "passes/shadow.hpp"
#include "passes/smoke_upload.hpp"
#include "shared/smoke_shadow.h"

namespace brume::passes {

class SmokeShadowPass {
 public:
  explicit SmokeShadowPass(gpu::Context& context);

  /// Optical depths, a layer for each layer of the shadow maps but coarser: smoke has no sharp edges.
  gpu::Image make_layers(gpu::Context& context, const ShadowMaps& shadows) const;
  /// Fills all layers.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SceneResources& scene,
              const ShadowMaps& shadows, const SmokeResources& smoke, const HoleResources& holes,
              const gpu::Image& layers) const;

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Sampler linear_, nearest_;
};

}  // namespace brume::passes
