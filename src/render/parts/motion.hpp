// The motion of the media from frame to frame, for hosts with an upscaler.
#pragma once

#include <optional>

#include "passes/smoke_motion.hpp"
#include "render/parts/frame_part.hpp"

namespace brume::render {

class MotionPart {
 public:
  /// `context` must outlive it. Throws resource_limit.
  MotionPart(gpu::Context& context, glm::uvec2 size_px) : context_(context) {
    pass_.emplace(context, size_px);
  }

  /// Frames of another size. When the device is done with what was recorded before.
  void resize(glm::uvec2 size_px) { pass_.emplace(context_, size_px); }
  /// After the march. `entries`: MarchPart::counters, with MediaOptions::record_entries.
  void record(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
              const gpu::Buffer& entries) const;

  /// As SmokeMotionPass writes it.
  const gpu::Image& motion() const { return pass_->motion(); }

 private:
  gpu::Context& context_;
  std::optional<passes::SmokeMotionPass> pass_;
};

}  // namespace brume::render
