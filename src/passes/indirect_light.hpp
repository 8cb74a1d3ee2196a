// Light that surfaces and smoke pass on to each other (shared/indirect_light.h).
#pragma once

#include <array>
#include <map>
#include <span>

#include "gpu/recorder.hpp"
#include "passes/media_resources.hpp"
#include "passes/scene_upload.hpp"
#include "passes/shadow.hpp"
#include "passes/solid_volume.hpp"
#include "planning/indirect_light_plan.hpp"
#include "shared/indirect_light.h"
#include "surfaces/light_cells.hpp"

namespace brume::passes {

class IndirectLightPass {
 public:
  explicit IndirectLightPass(gpu::Context& context);

  /// Makes room for a level of these cells, for as many lights as any of its frames has. Outside of a
  /// recording, when the device is done with what was recorded before. Throws resource_limit.
  void reserve(const surfaces::LightCells& level, std::size_t most_lights, std::uint32_t casters);
  /// Its pipelines alone.
  void reserve_pipelines(std::uint32_t casters);

  struct Inputs {
    const gpu::Buffer& frame;
    const ShadowMaps& shadows;
    const SolidVolume& solid;
    MediaResources media;  ///< As light meets them; `reserve` has seen their set.
    const gpu::Image& noise;
    float g = 0;                   ///< MediaPlan::mean_cosine.
    const gpu::Image& glow_field;  ///< GlowFieldPass::field.
  };
  /// Uploads the level of the last `reserve`.
  void upload(gpu::Recorder& recorder, const surfaces::LightCells& level) const;
  /// Does the slices of a plan. `media`: cells that may hold media, in the plan of the first slice; empty:
  /// none.
  void record(gpu::Recorder& recorder, const Inputs& in, const planning::IndirectLightPlan& plan,
              const Box<int>& media);

  /// The light of the last plan whose slices were all done; of one cell before the first `reserve`.
  const gpu::Image& cube() const { return cube_; }

 private:
  void begin(gpu::Recorder& recorder, const Inputs& in, std::span<const shared::Light> lights,
             const Box<int>& media);
  /// Dispatches what reads the lights, with `own` besides.
  template <typename... Own>
  void dispatch_lit(gpu::Recorder& recorder, const Inputs& in, const gpu::ComputePipeline& pipeline,
                    glm::uvec3 threads, Own... own);
  void record_media(gpu::Recorder& recorder, const Inputs& in);
  void record_sources(gpu::Recorder& recorder, const Inputs& in);
  void record_gather(gpu::Recorder& recorder, const Inputs& in, std::uint32_t slice, std::uint32_t count);
  void record_smooth(gpu::Recorder& recorder, const Inputs& in, float relaxation);
  bool has_media() const { return params_.media_low.x < params_.media_high.x; }

  gpu::Context& context_;
  gpu::ComputePipeline patches_pass_, medium_light_pass_, patch_radiance_pass_, medium_source_pass_,
      smooth_pass_;
  /// By whether there are media and small emitters.
  std::map<std::array<std::uint32_t, 2>, gpu::ComputePipeline> gather_passes_;
  std::map<std::uint32_t, gpu::ComputePipeline> medium_passes_;  ///< By the media of a frame.
  gpu::Sampler linear_, compare_;
  gpu::Buffer patches_, probes_, hits_, emitter_samples_, emitter_rays_, irradiance_, radiance_, lights_;
  gpu::Image cube_, next_cube_, noisy_cube_, medium_, medium_direct_, medium_matter_;
  std::uint32_t patch_count_ = 0, probe_count_ = 0, small_emitters_ = 0;
  shared::IndirectParams params_{};  ///< For the light that is being found.
};

}  // namespace brume::passes
