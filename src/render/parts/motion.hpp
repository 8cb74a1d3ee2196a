// The motion of the media from frame to frame, for hosts with an upscaler.
#pragma once

#include <array>

#include "passes/smoke_motion.hpp"
#include "render/parts/frame_part.hpp"

namespace brume::render {

class MotionPart {
 public:
  /// `context` must outlive it. Throws resource_limit.
  MotionPart(gpu::Context& context, glm::uvec2 size_px) : context_(context) {
    pass_.emplace(context, size_px);
  }

  /// Frames of another size; none continues. When the device is done with what was recorded before.
  void resize(glm::uvec2 size_px);
  /// After the march. `entries`: MarchPart::counters, with MediaOptions::record_entries.
  void record(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
              const gpu::Buffer& entries);

  /// As SmokeMotionPass writes it.
  const gpu::Image& motion() const { return pass_->motion(); }

 private:
  /// The last camera of each view, without jitter.
  using Pasts = std::array<std::optional<glm::mat4>, planning::kMaxViews>;

  gpu::Context& context_;
  std::optional<passes::SmokeMotionPass> pass_;
  gpu::Recorded<Pasts> pasts_;
};

}  // namespace brume::render
