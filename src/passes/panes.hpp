// Draws panes over a picture: what lets light through.
#pragma once

#include <compare>
#include <map>
#include <optional>

#include "passes/map_samplers.hpp"
#include "passes/media_resources.hpp"
#include "passes/shade.hpp"
#include "planning/view_frustum.hpp"

namespace brume::passes {

/// The panes of a scene at a time; `hidden` ones and those outside of `view` are not drawn.
struct VisiblePanes {
  const SceneResources& scene;
  std::span<const Draw> moving;
  HiddenObjects hidden;
  const planning::ViewFrustum& view;
  glm::vec3 forward{0, 0, -1};  ///< View axis of the camera, unit.
};

class PanePass {
 public:
  /// What a frame needs; each thing that it does not is faster.
  struct Needs {
    bool voxel_shadows = true;  ///< A light may be shadowed by voxels (kShadowByVoxels).
    std::uint32_t media = ~0u;  ///< Media that light meets: MediaPlan::casters.
    bool tanks = false;         ///< Inputs::tanks is given.
    auto operator<=>(const Needs&) const = default;
  };
  /// Tanks between the level and the media.
  struct Tanks {
    const gpu::Image& layers;  ///< Premultiplied radiance and transmittance of media and tanks.
    const gpu::Image& depth;   ///< Reverse depth of the surfaces, tanks included.
  };
  struct Inputs {
    const gpu::Buffer& frame;  ///< FrameConstants.
    const ShadowMaps& shadows;
    const SmokeShadows& smoke_shadows;
    LevelLight level;
    const gpu::Image& depth;  ///< Reverse depth of the other surfaces: GBuffer::depth.
    const gpu::Image& smoke;  ///< Premultiplied radiance and transmittance of the media up to these.
    MediaResources media;     ///< As light meets them.
    std::optional<Tanks> tanks = {};
  };

  explicit PanePass(gpu::Context& context);
  /// Prepares for frames of these needs. Outside of a recording.
  void reserve(const Needs& needs);
  /// Filters `radiance`, half floats, by each pane from back to front, and adds what it reflects; the alpha
  /// becomes the fraction that passes. Media before a pane are not filtered (shaders/panes_shine.frag).
  /// `needs` are reserved.
  void record(gpu::Recorder& recorder, const Needs& needs, const Inputs& in, const VisiblePanes& panes,
              const gpu::Image& radiance) const;

 private:
  void prepare(gpu::Recorder& recorder, const gpu::GraphicsPipeline& shine, const Inputs& in,
               const SceneResources& scene) const;
  void draw(gpu::Recorder& recorder, const gpu::GraphicsPipeline& shine, const Inputs& in,
            const SceneResources& scene, const Draw& draw) const;

  gpu::Context& context_;
  gpu::GraphicsPipeline filter_;
  std::map<Needs, gpu::GraphicsPipeline> shine_;
  MapSamplers maps_;
  gpu::Sampler nearest_, linear_, compare_;
};

}  // namespace brume::passes
