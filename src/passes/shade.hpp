// Lights the G-buffer.
#pragma once

#include "passes/gbuffer.hpp"
#include "passes/shadow.hpp"

namespace brume::passes {

class ShadePass {
 public:
  explicit ShadePass(gpu::Context& context);
  /// Writes radiance (half floats) to `lit`; `smoke_shadows` as SmokeShadowPass makes it.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SceneResources& scene,
              const ShadowMaps& shadows, const gpu::Image& smoke_shadows, const GBuffer& gbuffer,
              const gpu::Image& lit) const;

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Sampler nearest_, linear_, compare_;
};

}  // namespace brume::passes
