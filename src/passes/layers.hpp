// Layers of a picture, one over the other: premultiplied radiance and, in alpha, transmittance.
#pragma once

#include "gpu/recorder.hpp"

namespace brume::passes {

class LayerPass {
 public:
  explicit LayerPass(gpu::Context& context);

  /// Empties `layers`, of half floats: nothing is there, and all light passes.
  void begin(gpu::Recorder& recorder, const gpu::Image& layers) const;
  /// Adds a layer over those so far, of the same size.
  void add(gpu::Recorder& recorder, const gpu::Image& over, const gpu::Image& layers) const;

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Sampler nearest_;
};

}  // namespace brume::passes
