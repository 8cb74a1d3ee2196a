// Enlarges an image to the window's size along its edges.
#pragma once

#include "gpu/recorder.hpp"

namespace brume::viewer {

class UpscalePass {
 public:
  explicit UpscalePass(gpu::Context& context);
  /// Fills `target` (RGBA8, a storage image) with `source`, whatever their sizes.
  void record(gpu::Recorder& recorder, const gpu::Image& source, const gpu::Image& target) const;

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Sampler nearest_;
};

}  // namespace brume::viewer
