// Shadows of smoke and volumes on surfaces.
#pragma once

#include <map>

#include "passes/media_resources.hpp"
#include "passes/shadow.hpp"
#include "passes/solid_volume.hpp"
#include "planning/smoke_shadow_cache.hpp"

namespace brume::passes {

/// See shared/smoke_shadow.h.
struct SmokeShadows {
  gpu::Image atlas;   ///< Half floats: transmittance.
  gpu::Buffer faces;  ///< SmokeShadowFace, kFacesPerLight for each light.
};

class SmokeShadowPass {
 public:
  explicit SmokeShadowPass(gpu::Context& context);
  /// For images of this size: a ray for eight pixels, at least 2^16 and at most 2^19 rays. Holds no smoke
  /// until the first record.
  SmokeShadows make_shadows(gpu::Context& context, glm::uvec2 image_px, std::size_t max_lights) const;

  struct Inputs {
    const gpu::Buffer& frame;
    const SceneResources& scene;
    const ShadowMaps& shadows;
    const SolidVolume& solid;
    MediaResources media;  ///< As light meets them; `reserve` has seen their set.
  };
  /// Makes room for a set of media. Outside of a recording.
  void reserve(std::uint32_t casters);
  /// Uploads the plan of an update.
  static void upload(gpu::Recorder& recorder, const planning::SmokeShadowUpdate& update,
                     const SmokeShadows& shadows);
  /// Marches the rays of an uploaded update for the atlas; its plan's lights are in the scene's buffer.
  void record(gpu::Recorder& recorder, const Inputs& inputs, const planning::SmokeShadowUpdate& update,
              const SmokeShadows& shadows) const;

 private:
  gpu::Context& context_;
  std::map<std::uint32_t, gpu::ComputePipeline> pipelines_;  ///< By media.
  gpu::Sampler nearest_;
};

}  // namespace brume::passes
