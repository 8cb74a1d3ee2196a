// Directional visibility of the sky at each point of a level.
#pragma once

#include "passes/solid_volume.hpp"
#include "shared/sky_light.h"

namespace brume::passes {

class SkyLightPass {
 public:
  explicit SkyLightPass(gpu::Context& context);
  /// Makes room for the light of the level that `solid` has room for. When SolidVolume::reserve may be
  /// called.
  void reserve(const SolidVolume& solid);
  /// Lights the level; required only when the solid volume changed. `frame` holds FrameConstants.
  void record(gpu::Recorder& recorder, const gpu::Buffer& frame, const SolidVolume& solid) const;
  /// Half floats, a texel per texel of the solid volume (shared/sky_light.h).
  const gpu::Image& light() const { return light_; }
  const gpu::Buffer& rays() const {
    return rays_;
  }  ///< For tests: per direction the words of the solid volume.

 private:
  gpu::Context& context_;
  gpu::ComputePipeline rays_pipeline_, light_pipeline_;
  gpu::Buffer rays_;
  gpu::Image light_;
};

}  // namespace brume::passes
