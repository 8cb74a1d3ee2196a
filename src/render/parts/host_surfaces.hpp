// The surfaces that a host drew for a frame, and what its own picture takes from the frame.
#pragma once

#include <optional>

#include "passes/surface_import.hpp"
#include "render/parts/frame_part.hpp"

namespace brume::render {

/// The surfaces of a frame, from its camera.
struct HostSurfaces {
  const gpu::Image& depth;
  passes::HostDepthRange range;
  glm::uvec2 origin_px{0};           ///< Where the frame begins in the host's images.
  passes::HostNormals normals = {};  ///< For decals.
};

class HostSurfacesPart {
 public:
  /// `context` must outlive it.
  explicit HostSurfacesPart(gpu::Context& context)
      : context_(context), import_pass_(context), layer_pass_(context) {}

  /// Frames of another size. When the device is done with what was recorded before.
  void resize() {
    shadows_ = {};
    has_no_emission_.change(context_) = false;
  }
  // Make room, outside of a recording; throw resource_limit.
  void reserve_samples() { import_pass_.reserve_samples(); }
  void reserve_normals(Targets& targets);
  void reserve_shadows(glm::uvec2 size_px);
  /// For pictures of a format that can be blended.
  void reserve_layer(VkFormat format) { layer_pass_.reserve(format); }

  /// The depth of the surfaces, in the place of a G-buffer.
  void record_depth(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                    const HostSurfaces& surfaces);
  void record_normals(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                      const HostSurfaces& surfaces) const;
  /// The media's shadows on the surfaces, of up to four `lights`: the scene's by their place in it, then
  /// the frame's flashes.
  void record_shadows(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                      std::span<const std::uint32_t> lights);
  /// Draws the layer over a part of a picture of a reserved format.
  void record_layer(gpu::Recorder& recorder, const passes::MediaLayerPass::Layer& layer,
                    const gpu::Image& picture, const passes::HostPart& part) const;

  /// As SurfaceShadowPass writes them.
  const gpu::Image& shadows() const { return shadows_; }

 private:
  gpu::Context& context_;
  passes::SurfaceImport import_pass_;
  std::optional<passes::SurfaceNormalPass> normal_pass_;  ///< From the first frame with decals on.
  std::optional<passes::SurfaceShadowPass> shadow_pass_;  ///< From the first frame that asks for shadows on.
  passes::MediaLayerPass layer_pass_;
  gpu::Image shadows_;
  gpu::Recorded<bool> has_no_emission_;  ///< The G-buffer's emission is 0: frames of a host never change it.
};

}  // namespace brume::render
