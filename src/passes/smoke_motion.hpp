// Where the media of each pixel are, and where they were in the frame before: for a host's upscaler.
#pragma once

#include <optional>

#include "gpu/recorder.hpp"
#include "planning/device_camera.hpp"
#include "shared/smoke_motion.h"

namespace brume::passes {

class SmokeMotionPass {
 public:
  /// For frames up to this size. Throws resource_limit.
  SmokeMotionPass(gpu::Context& context, glm::uvec2 size_px);

  struct Inputs {
    const gpu::Buffer& frame;    ///< FrameConstants.
    const gpu::Image& depth;     ///< Depth of the G-buffer.
    const gpu::Image& smoke;     ///< Premultiplied radiance and transmittance of the frame.
    const gpu::Buffer& entries;  ///< As MarchPass::Options::record_entries writes them.
    glm::uvec2 size_px;          ///< The frame's size.
  };
  /// Writes motion(). `past`: where motions lead; empty: they are 0. `jitter_px`: from the middle of each
  /// pixel to the point that it shows, y down.
  void record(gpu::Recorder& recorder, const Inputs& inputs, const std::optional<planning::PastView>& past,
              glm::vec2 jitter_px) const;
  /// Half floats: in red and green from where the media of a pixel are to where they were [px], right and
  /// down; in blue the distance along the view axis at which their transmittance falls to
  /// shared::kEntryTransmittance, in alpha the mean distance of their light [m]. Infinite without media.
  const gpu::Image& motion() const { return motion_; }

 private:
  gpu::ComputePipeline pipeline_;
  gpu::Sampler nearest_;
  gpu::Image motion_;
};

}  // namespace brume::passes
