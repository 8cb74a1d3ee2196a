// Temporal accumulation of smoke: averages out the jitter and the gaps between rays.
#pragma once

#include <array>

#include "gpu/recorder.hpp"
#include "shared/accumulate.h"
#include "shared/frame.h"

namespace brume::passes {

class AccumulatePass {
 public:
  /// Stores two frames up to this size. Throws resource_limit.
  AccumulatePass(gpu::Context& context, glm::uvec2 size_px);

  /// Blends `smoke` (premultiplied radiance and transmittance, half floats) with the previous result; the
  /// new result is gathered(). `frame` holds FrameConstants with this camera and size, `depth` is the
  /// G-buffer's. Frames of another size go on from those before.
  /// Without `continues`, and at first, the history is dropped and the result is `smoke`.
  ///
  /// A pixel is the mean of at most kAccumulatedFrames frames, clamped to one standard deviation around the
  /// mean of the 3 x 3 pixels around it in this frame, a range that includes its own value.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, const shared::Camera& camera,
              glm::uvec2 size_px, const gpu::Image& depth, const gpu::Image& smoke, bool continues);
  const gpu::Image& gathered() const { return smoke_[past_.get(context_).current]; }

 private:
  /// What the last frame left for the next one.
  struct Past {
    std::size_t current = 0;
    bool is_valid = false;
    glm::mat4 clip_from_world{1};
    glm::uvec2 size_px{1};
    bool is_clear = false;  ///< The images hold numbers, also beside frames that are smaller.
  };
  gpu::Context& context_;
  gpu::ComputePipeline pipeline_;
  gpu::Sampler nearest_, linear_;
  std::array<gpu::Image, 2> smoke_;    // alternating
  std::array<gpu::Buffer, 2> pixels_;  // shared::AccumulatedPixel
  gpu::Recorded<Past> past_;
};

}  // namespace brume::passes
