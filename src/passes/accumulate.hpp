// Gathers the smoke of frame after frame: its jitter and the gaps between its rays average out.
#pragma once

#include <array>

#include "gpu/recorder.hpp"
#include "shared/accumulate.h"
#include "shared/frame.h"

namespace brume::passes {

class AccumulatePass {
 public:
  /// Keeps two frames of this size. Throws resource_limit.
  AccumulatePass(gpu::Context& context, glm::uvec2 size_px);

  /// Mixes `smoke` (premultiplied radiance and transmittance, half floats) with what the frame before left;
  /// the result is in gathered(). `frame` holds FrameConstants with this camera, `depth` is the G-buffer's.
  /// With `continues` the frame before is the one that was recorded before; without, the result is `smoke`.
  ///
  /// What a pixel shows is the mean of at most kAccumulatedFrames frames, and lies within one standard
  /// deviation of the mean of the 3x3 pixels around it in this frame, or between there and its own value.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, const shared::Camera& camera,
              const gpu::Image& depth, const gpu::Image& smoke, bool continues);
  const gpu::Image& gathered() const { return smoke_[current_]; }

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Sampler nearest_, linear_;
  std::array<gpu::Image, 2> smoke_;    // by turns
  std::array<gpu::Buffer, 2> pixels_;  // shared::AccumulatedPixel
  std::size_t current_ = 0;
  glm::mat4 past_clip_from_world_{1};
};

}  // namespace brume::passes
