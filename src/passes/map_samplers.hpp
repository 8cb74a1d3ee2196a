// The samplers of a scene's images: one for each way in which an image continues beyond its edges.
#pragma once

#include <deque>

#include "gpu/recorder.hpp"
#include "passes/scene_upload.hpp"

namespace brume::passes {

class MapSamplers {
 public:
  MapSamplers(gpu::Context& context, float anisotropy);

  /// An image of the scene with its sampler; index into SceneResources::images.
  gpu::Binding sampled(const SceneResources& scene, std::uint32_t image) const;
  /// Makes all images of the scene readable by draws.
  void prepare_for_draws(gpu::Recorder& recorder, const SceneResources& scene) const;

 private:
  std::deque<gpu::Sampler> samplers_;  // by the wraps along v, then u
};

}  // namespace brume::passes
