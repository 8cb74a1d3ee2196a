// The march at a reduced resolution: one ray for a block of pixels, and the smoke of each pixel from the rays
// around.
#pragma once

#include "gpu/recorder.hpp"
#include "passes/march.hpp"

namespace brume::passes {

class ResolvePass {
 public:
  explicit ResolvePass(gpu::Context& context);

  /// Finds where the ray of each block runs, and the depths of its surfaces. `frame` holds FrameConstants,
  /// `depth` is the G-buffer's.
  void record_ends(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& depth,
                   const MarchTiles& blocks) const;
  /// Lists the blocks where interpolation between rays would be seen: off by more than 3/255 on the screen,
  /// in front of a surface that shines as `emission` (the G-buffer's) says or that stands in bright light.
  void record_select(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& emission,
                     const MarchTiles& blocks) const;
  /// Writes premultiplied radiance and transmittance of every pixel to `smoke` (half floats) from the marched
  /// blocks.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& depth,
              const MarchTiles& blocks, const gpu::Image& smoke) const;

 private:
  gpu::ComputePipeline ends_, select_, resolve_;
  gpu::Sampler nearest_;
};

}  // namespace brume::passes
