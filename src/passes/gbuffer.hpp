// Draws the scene into the G-buffer.
#pragma once

#include <span>

#include "passes/scene_upload.hpp"
#include "planning/view_frustum.hpp"

namespace brume::passes {

/// Material, normal and depth of the nearest surface of each pixel.
struct GBuffer {
  gpu::Image albedo_roughness;  ///< sRGB8 albedo, roughness in alpha.
  gpu::Image normal_metallic;   ///< Half floats: world normal, metallic.
  gpu::Image emission;          ///< Half floats: radiance.
  gpu::Image depth;             ///< Reverse depth, 0: no surface.
  GBuffer(gpu::Context& context, glm::uvec2 size_px);
};

class GBufferPass {
 public:
  explicit GBufferPass(gpu::Context& context);
  /// Draws the scene and `moving`, without `hidden` objects and draws outside of `view`.
  /// `frame` holds FrameConstants.
  void record(gpu::Recorder& recorder, const SceneResources& scene, std::span<const Draw> moving,
              HiddenObjects hidden, const planning::ViewFrustum& view, const gpu::Buffer& frame,
              const GBuffer& target) const;

 private:
  gpu::GraphicsPipeline pipeline_;
  gpu::Sampler sampler_;
};

}  // namespace brume::passes
