// Light from every lamp and from the sky at every texel of the smoke's bricks that may be in view
// (shared/smoke_light.h).
#pragma once

#include "passes/open_holes.hpp"
#include "passes/shade.hpp"
#include "passes/shadow.hpp"
#include "passes/smoke_upload.hpp"

namespace brume::passes {

class SmokeLightPass {
 public:
  explicit SmokeLightPass(gpu::Context& context);

  struct Inputs {
    const gpu::Buffer& frame;
    const SceneResources& scene;
    const ShadowMaps& shadows;
    const SmokeResources& smoke;
    const HoleResources& holes;
    LevelLight level;
  };
  /// Makes room for the light of this many bricks in view and of so many lamps. Not between the begin and the end of a
  /// recording, and only when the device is done with what it recorded before. Throws resource_limit.
  void reserve(std::uint32_t slot_count, std::uint32_t light_count);
  /// Fills smoke.inscatter where a ray of the frame's camera can meet smoke.
  void record(gpu::Recorder& recorder, const Inputs& inputs);

 private:
  void record_slots(gpu::Recorder& recorder, const Inputs& inputs, std::uint32_t first, std::uint32_t count);

  gpu::Context& context_;
  gpu::ComputePipeline texels_pass_, rays_pass_, depth_pass_, inscatter_pass_;
  gpu::Sampler linear_, compare_;
  gpu::Buffer texels_, rays_, ray_light_, counters_;
  std::uint32_t rays_per_texel_ = 0, slots_at_once_ = 0;
};

}  // namespace brume::passes
