// Puts the smoke over the scene.
#pragma once

#include "gpu/recorder.hpp"

namespace brume::passes {

class CompositePass {
 public:
  explicit CompositePass(gpu::Context& context);
  /// picture = smoke radiance + smoke transmittance * lit; all half floats of one size.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& smoke,
              const gpu::Image& lit, const gpu::Image& picture) const;

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Sampler nearest_;
};

}  // namespace brume::passes
