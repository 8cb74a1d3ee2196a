// The march at a reduced resolution: one ray for a block of pixels, and the smoke of each pixel from the rays
// around.
#pragma once

#include "gpu/recorder.hpp"
#include "passes/march.hpp"

namespace brume::passes {

/// Blocks of scale x scale pixels, one ray each.
struct MarchBlocks {
  gpu::Buffer ends;  ///< shared::RayEnds, rows in order.
  gpu::Image near;   ///< Half floats, a texel a block: the smoke up to the block's nearest surface.
  gpu::Image far;    ///< The same up to its farthest.
  /// `scale` is 1, 2 or 4. Throws resource_limit.
  MarchBlocks(gpu::Context& context, glm::uvec2 size_px, std::uint32_t scale);
};

class ResolvePass {
 public:
  explicit ResolvePass(gpu::Context& context);

  /// Finds where the ray of each block runs, and the depths of its surfaces. `frame` holds FrameConstants,
  /// `depth` is the G-buffer's.
  void record_ends(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& depth,
                   const MarchBlocks& blocks) const;
  /// Writes premultiplied radiance and transmittance of every pixel to `smoke` (half floats) from the marched
  /// blocks.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, const gpu::Image& depth,
              const MarchBlocks& blocks, const gpu::Image& smoke) const;

 private:
  gpu::ComputePipeline ends_, resolve_;
  gpu::Sampler nearest_;
};

}  // namespace brume::passes
