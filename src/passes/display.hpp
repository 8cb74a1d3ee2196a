// Radiance to the 8 bits of a screen.
#pragma once

#include "gpu/recorder.hpp"

namespace brume::passes {

class DisplayPass {
 public:
  explicit DisplayPass(gpu::Context& context);
  /// Exposure, tone curve, sRGB and dither from `picture` (half floats) to `display` (RGBA8).
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& blue_noise,
              const gpu::Image& picture, const gpu::Image& display) const;

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Sampler nearest_;
};

}  // namespace brume::passes
