// Radiance to 8-bit display values.
#pragma once

#include "gpu/recorder.hpp"

namespace brume::passes {

class DisplayPass {
 public:
  explicit DisplayPass(gpu::Context& context);
  /// Applies exposure, tone curve, sRGB and dither, from `radiance` (half floats) to `display` (RGBA8).
  /// `dither`: size of its noise in steps of 8 bits; 1 removes all bands, 0 shows them.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& blue_noise,
              const gpu::Image& radiance, const gpu::Image& display, float dither = 1) const;

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Sampler nearest_;
};

}  // namespace brume::passes
