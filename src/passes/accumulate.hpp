// Temporal accumulation of smoke: averages out the jitter and the gaps between rays.
#pragma once

#include <array>
#include <optional>

#include "gpu/recorder.hpp"
#include "planning/device_camera.hpp"
#include "shared/accumulate.h"

namespace brume::passes {

class AccumulatePass {
 public:
  /// Stores two frames up to this size. Throws resource_limit.
  AccumulatePass(gpu::Context& context, glm::uvec2 size_px);

  /// Blends `smoke` (premultiplied radiance and transmittance, half floats) with the previous result; the
  /// new result is gathered(). `frame` holds FrameConstants with this size, `depth` is the G-buffer's.
  /// `past`: the frame of the last record, which may have another size. Without it, and at first, the result
  /// is `smoke`.
  ///
  /// A pixel is the mean of at most kAccumulatedFrames frames, clamped to one standard deviation around the
  /// mean of the 3 x 3 pixels around it in this frame, a range that includes its own value.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, glm::uvec2 size_px, const gpu::Image& depth,
              const gpu::Image& smoke, const std::optional<planning::PastView>& past);
  const gpu::Image& gathered() const { return smoke_[stored_.get(context_).current]; }

 private:
  /// What the last frame left for the next one.
  struct Stored {
    std::size_t current = 0;
    bool is_valid = false;
    bool is_clear = false;  ///< The images hold numbers, also beside frames that are smaller.
  };
  gpu::Context& context_;
  gpu::ComputePipeline pipeline_;
  gpu::Sampler nearest_, linear_;
  std::array<gpu::Image, 2> smoke_;    // alternating
  std::array<gpu::Buffer, 2> pixels_;  // shared::AccumulatedPixel
  gpu::Recorded<Stored> stored_;
};

}  // namespace brume::passes
