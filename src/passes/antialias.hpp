// Temporal antialiasing: smooths edges over the frames of a film that each show another point of every pixel.
#pragma once

#include <array>

#include "gpu/recorder.hpp"
#include "shared/antialias.h"
#include "shared/frame.h"

namespace brume::passes {

class AntialiasPass {
 public:
  /// Stores two frames of this size. Throws resource_limit.
  AntialiasPass(gpu::Context& context, glm::uvec2 size_px);

  struct Inputs {
    const gpu::Buffer& frame;  ///< FrameConstants with the camera of this frame, jitter included.
    const gpu::Image& depth;   ///< GBuffer::depth.
    const gpu::Image& media;   ///< Premultiplied radiance and transmittance.
    const gpu::Image& radiance;
  };
  /// Blends `radiance` with the previous result; the new one is result(). Without `continues` the history is
  /// dropped and the result is `radiance`. `clip_from_world`: of this frame without `jitter`, which is from
  /// the middle of each pixel to the point that the frame shows, y down [px].
  ///
  /// A pixel is the mean of at most kAntialiasedFrames frames, of fewer where the image moves, clamped to one
  /// standard deviation around the mean of the 3 x 3 pixels around it in this frame, a range that includes
  /// its own value.
  void record(gpu::Recorder& recorder, const Inputs& in, const glm::mat4& clip_from_world, glm::vec2 jitter,
              bool continues);
  /// Drops the history: the next frame does not continue it.
  void invalidate_past(gpu::Recorder& recorder) { recorder.change(past_).is_valid = false; }
  /// Half floats: radiance, and of how many frames it is the mean.
  const gpu::Image& result() const { return radiance_[past_.get(context_).current]; }

 private:
  /// What the last frame left for the next one.
  struct Past {
    std::size_t current = 0;
    bool is_valid = false;
    glm::mat4 clip_from_world{1};
  };
  gpu::Context& context_;
  gpu::ComputePipeline pipeline_;
  gpu::Sampler nearest_, linear_;
  std::array<gpu::Image, 2> radiance_;  // alternating
  gpu::Recorded<Past> past_;
};

}  // namespace brume::passes
