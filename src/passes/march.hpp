// Marches rays through the smoke.
#pragma once

#include "passes/hole_grid.hpp"
#include "passes/smoke_upload.hpp"
#include "shared/resolve.h"

namespace brume::passes {

class MarchPass {
 public:
  /// `rays` is shared::kRaysOfPixels or kRaysOfBlocks. With `count_samples`, record adds the texture samples
  /// taken to the first word of `counters`.
  MarchPass(gpu::Context& context, bool count_samples, std::uint32_t rays = shared::kRaysOfPixels);

  struct Inputs {
    const gpu::Buffer& frame;
    const SmokeResources& smoke;
    const gpu::Image& noise;
    const gpu::Image& depth;
    const gpu::Image& blue_noise;
    const HoleResources& holes;
  };
  /// Marches the ray of each pixel. Writes premultiplied radiance and transmittance (half floats) to `smoke`.
  void record(gpu::Recorder& recorder, const Inputs& inputs, const gpu::Image& smoke,
              const gpu::Buffer& counters) const;

  /// The rays of blocks of pixels: where they run, and what they see up to the nearest and to the farthest
  /// surface of their block. See passes/resolve.hpp.
  struct Blocks {
    const gpu::Buffer& ends;  ///< shared::RayEnds, one a block.
    const gpu::Image& near;   ///< Half floats, a texel a block.
    const gpu::Image& far;
  };
  void record(gpu::Recorder& recorder, const Inputs& inputs, const Blocks& blocks,
              const gpu::Buffer& counters) const;

 private:
  void record(gpu::Recorder& recorder, const Inputs& inputs, const gpu::Buffer& ends, const gpu::Image& near,
              const gpu::Image& far, const gpu::Buffer& counters) const;

  gpu::ComputePipeline pipeline_;
  gpu::Sampler linear_, repeat_, nearest_;
};

}  // namespace brume::passes
