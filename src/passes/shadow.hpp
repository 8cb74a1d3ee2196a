// Shadow maps: six faces around a light, and the sun's map, one view along a directional light.
#pragma once

#include <functional>
#include <optional>

#include "passes/map_samplers.hpp"

namespace brume::passes {

struct ShadowMaps {
  gpu::Image layers;   ///< A 2D array, reverse depth.
  gpu::Image sun_map;  ///< Reverse depth.
  gpu::Buffer sun;     ///< One ShadowView.
  glm::mat4 sun_clip_from_world{1};
};

/// Edge of the sun's map in texels, of 5 cm at most in scenes with a diagonal of up to 200 m. `radius`: half
/// of the diagonal [m].
std::uint32_t sun_map_size(float radius);
/// Edge of a shadow layer in texels: smaller for more layers, to limit memory.
std::uint32_t shadow_size(std::uint32_t layer_count);

class ShadowPass {
 public:
  explicit ShadowPass(gpu::Context& context);
  ShadowMaps make_maps(gpu::Context& context, const SceneResources& scene) const;
  /// Draws every layer and the sun's map without the hidden objects. The scene is static: once suffices until
  /// other objects are hidden.
  void record(gpu::Context& context, gpu::CommandStream& stream, const SceneResources& scene,
              HiddenObjects hidden, const ShadowMaps& maps) const;
  /// Redraws the layers, and the sun's map, in which one of the `changed` objects (ascending) may be visible.
  void record_changed(gpu::Context& context, gpu::CommandStream& stream, const SceneResources& scene,
                      HiddenObjects hidden, std::span<const std::uint32_t> changed,
                      const ShadowMaps& maps) const;

 private:
  using Sees = std::function<bool(const Draw&)>;
  void record_layers(gpu::Context& context, gpu::CommandStream& stream, const SceneResources& scene,
                     HiddenObjects hidden, const ShadowMaps& maps,
                     const std::function<bool(const Sees&)>& accepts) const;
  /// A layer, or the sun's map, and what it shows.
  struct Layer {
    std::optional<std::uint32_t> index;  ///< None: the sun's map.
    glm::mat4 clip_from_world;
    std::vector<const Draw*> whole = {}, cut = {};  ///< What no texture cuts out, and the rest.
  };
  /// Pipelines for surfaces that no texture cuts out, and for the rest.
  struct Pipelines {
    gpu::GraphicsPipeline whole, cut;
  };
  void record_layer(gpu::Recorder& recorder, const SceneResources& scene, const Layer& layer,
                    const Pipelines& pipelines, const gpu::Image& map, VkImageView view) const;
  static Pipelines make_pipelines(gpu::Context& context, float slope);
  Pipelines pipelines_, fine_pipelines_;
  MapSamplers maps_;
};

}  // namespace brume::passes
