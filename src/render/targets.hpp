// The images that every kind of frame draws into. All have the frame's size.
#pragma once

#include "passes/gbuffer.hpp"

namespace brume::render {

struct Targets {
  /// `size_px`: each side in [1, 16384]. Throws resource_limit.
  Targets(gpu::Context& context, glm::uvec2 size_px);
  /// Targets for media over surfaces that a host draws: media alone, and what GBuffer::imported has.
  static Targets of_media(gpu::Context& context, glm::uvec2 size_px);

  glm::uvec2 size_px;
  passes::GBuffer gbuffer;
  gpu::Image media;     ///< Half floats: premultiplied radiance and transmittance of the media.
  gpu::Image radiance;  ///< Half floats: media, surfaces and particles.
  gpu::Image display;   ///< RGBA8, sRGB.

 private:
  Targets(glm::uvec2 size, passes::GBuffer&& surfaces, gpu::Image&& media_target);
};

}  // namespace brume::render
