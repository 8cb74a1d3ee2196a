// Marches rays through the smoke.
#pragma once

#include "passes/smoke_upload.hpp"
#include "shared/frame.h"
#include "shared/hole.h"

namespace brume::passes {

/// Most holes that are drawn at a time.
constexpr std::uint32_t kMaxHoles = 64;

class MarchPass {
 public:
  /// With `count_samples`, record adds the texture samples taken to the first word of `counters`.
  MarchPass(gpu::Context& context, bool count_samples);

  struct Inputs {
    const gpu::Buffer& frame;
    const SmokeResources& smoke;
    const gpu::Image& worley;
    const gpu::Image& depth;
    const gpu::Image& blue_noise;
    const gpu::Buffer& holes;  ///< shared::Hole, frame.hole_count of them.
  };
  /// Writes premultiplied radiance and transmittance (half floats) to `smoke`.
  void record(gpu::Recorder& recorder, const Inputs& inputs, const gpu::Image& smoke,
              const gpu::Buffer& counters) const;

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Sampler linear_, repeat_, nearest_;
};

}  // namespace brume::passes
