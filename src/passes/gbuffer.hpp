// Draws the scene into the G-buffer.
#pragma once

#include <optional>
#include <span>

#include "passes/map_samplers.hpp"
#include "planning/view_frustum.hpp"

namespace brume::passes {

/// Material, normal and depth of the nearest surface of each pixel. Without a surface the first two are
/// undefined.
struct GBuffer {
  gpu::Image albedo_roughness;  ///< sRGB8 albedo, roughness in alpha.
  gpu::Image normal_metallic;   ///< Half floats: world normal, metallic.
  gpu::Image emission;          ///< Half floats: radiance; 0 without a surface.
  gpu::Image depth;             ///< Reverse depth, 0: no surface.
  GBuffer(gpu::Context& context, glm::uvec2 size_px);
  /// A G-buffer of surfaces that a host draws (SurfaceImport): depth, and an emission of 0.
  static GBuffer imported(gpu::Context& context, glm::uvec2 size_px);
  /// Adds the normals of such surfaces, for SurfaceNormalPass. Throws resource_limit.
  void add_imported_normals(gpu::Context& context);

 private:
  GBuffer() = default;
};

class GBufferPass {
 public:
  /// In the form that suits the device.
  explicit GBufferPass(gpu::Context& context);
  /// `depth_first`: as in gpu::Tuning. The same surfaces.
  GBufferPass(gpu::Context& context, bool depth_first);
  /// Draws the scene and `moving`, without `hidden` objects and draws outside of `view`.
  /// `frame` holds FrameConstants.
  void record(gpu::Recorder& recorder, const SceneResources& scene, std::span<const Draw> moving,
              HiddenObjects hidden, const planning::ViewFrustum& view, const gpu::Buffer& frame,
              const GBuffer& target) const;

  struct VisibleDraw {
    const Draw* draw;
    bool moves;  ///< Over the level.
  };

 private:
  /// What it takes to draw depth first.
  struct DepthFirst {
    explicit DepthFirst(gpu::Context& context);
    gpu::GraphicsPipeline depth, dull;
    gpu::ComputePipeline clear;  ///< Sets the emission to 0.
  };
  void draw_depth_first(gpu::Recorder& recorder, const SceneResources& scene,
                        std::span<const VisibleDraw> draws, std::span<const VisibleDraw> dull,
                        const planning::ViewFrustum& view, const gpu::Buffer& frame,
                        const GBuffer& target) const;
  void draw_depth(gpu::Recorder& recorder, const SceneResources& scene, std::vector<VisibleDraw> draws,
                  const planning::ViewFrustum& view, const gpu::Buffer& frame) const;
  void draw_materials(gpu::Recorder& recorder, const gpu::GraphicsPipeline& pipeline,
                      const SceneResources& scene, std::span<const VisibleDraw> draws,
                      const gpu::Buffer& frame) const;

  gpu::GraphicsPipeline pipeline_;
  std::optional<DepthFirst> depth_first_;
  MapSamplers maps_;
};

}  // namespace brume::passes
