// The mean of the frames of a picture, such as one frame for each point of a lens.
#pragma once

#include "gpu/recorder.hpp"

namespace brume::passes {

class AveragePass {
 public:
  /// Sums frames of this size. Throws resource_limit.
  AveragePass(gpu::Context& context, glm::uvec2 size_px);

  /// Replaces `radiance` (half floats, clamped to 65504) of frame `index` of a picture by the mean of all up
  /// to it; 0 begins a picture.
  void record(gpu::Recorder& recorder, const gpu::Image& radiance, std::uint32_t index) const;

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Image sum_;
};

}  // namespace brume::passes
