// Light of all lights and of the sky at every texel of the smoke's bricks that may be visible
// (shared/smoke_light.h).
#pragma once

#include <map>

#include "passes/media_resources.hpp"
#include "passes/shade.hpp"
#include "passes/shadow.hpp"
#include "planning/smoke_light_cache.hpp"

namespace brume::passes {

class SmokeLightPass {
 public:
  explicit SmokeLightPass(gpu::Context& context);

  struct Inputs {
    const gpu::Buffer& frame;
    const SceneResources& scene;
    const ShadowMaps& shadows;
    LevelLight level;
    MediaResources media;  ///< As light meets them; `reserve` has seen their set.
  };
  /// What is cached, which a plan with this room may rely on.
  planning::SmokeLightRoom room() const;
  /// Makes room for a plan: where it exceeds room(), what was cached is lost. Not between the begin and the
  /// end of a recording, and only when the device is done with what it recorded before. Throws
  /// resource_limit.
  void reserve(const planning::SmokeLightPlan& plan, std::uint32_t casters);
  /// Its pipelines alone.
  void reserve_pipelines(std::uint32_t casters);
  /// Gives back what was cached; the next plan must not rely on it. When `reserve` may be called.
  void trim();
  /// Uploads the reserved plan.
  void upload(gpu::Recorder& recorder, const planning::SmokeLightPlan& plan);
  // The three steps of a part bring smoke.inscatter to the plan's frame, where a ray of its camera can meet
  // smoke. The parts come one after the other; the dispatches of a step are independent
  // (gpu::Recorder::concurrently). record_texel_lists is also independent of what advects noise and lists
  // holes.
  using Part = planning::SmokeLightPlan::Part;
  void record_texel_lists(gpu::Recorder& recorder, const Inputs& in, const Part& part) const;
  void record_rays(gpu::Recorder& recorder, const Inputs& in, const Part& part) const;
  void record_gathers(gpu::Recorder& recorder, const Inputs& in, const Part& part) const;

 private:
  const gpu::ComputePipeline& rays_pass(const Inputs& inputs) const;
  void dispatch_rays(gpu::Recorder& recorder, const Inputs& in, const volume::IndexRange& range,
                     std::uint32_t threads) const;
  void dispatch_gathers(gpu::Recorder& recorder, const Inputs& in, const volume::IndexRange& range,
                        std::uint32_t threads) const;
  /// Calls dispatch(range, threads) for items of all texels, and for the sliced ones, at the end, of some
  /// phases. `group`: threads of a workgroup.
  template <typename Dispatch>
  void for_slices(const Part& part, const volume::IndexRange& range, std::uint32_t sliced,
                  std::uint32_t group, const Dispatch& dispatch) const;

  gpu::Context& context_;
  gpu::ComputePipeline texels_pass_, inscatter_pass_;
  std::map<std::uint32_t, gpu::ComputePipeline> rays_passes_;  ///< By media.
  gpu::Sampler linear_, compare_;
  gpu::Buffer texel_lists_, ray_pages_;                                            // what is cached
  gpu::Buffer listed_bricks_, changes_, shadow_rays_, gathers_, gathered_lights_;  // the lists of a plan
};

}  // namespace brume::passes
