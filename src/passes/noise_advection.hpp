// Advection of the smoke's noise, and the atlases that rays from the eye and to lights read.
#pragma once

#include "passes/smoke_upload.hpp"
#include "planning/noise_plan.hpp"
#include "sim/state.hpp"
#include "smoke/cloud_growth.hpp"

namespace brume::passes {

class NoiseAdvectionPass {
 public:
  explicit NoiseAdvectionPass(gpu::Context& context);

  struct Inputs {
    const gpu::Buffer& frame;
    const SmokeResources& smoke;
    const gpu::Image& noise;
  };
  /// Makes room for the clouds of a state, whose noise is planned. When SmokeUpload::reserve may be called,
  /// with the same volume.
  void reserve(const sim::State& state, const smoke::SmokeBricks& volume, const planning::NoisePlan& plan);
  /// Gives back the memory of what `reserve` makes room for, before it is called the next time.
  void trim();
  /// Uploads the reserved plan.
  void upload(gpu::Recorder& recorder, const planning::NoisePlan& plan);
  /// Fills smoke.density_displacement (shaders/shared/smoke_volume.h; the noise at a point is read at point +
  /// GBA) and smoke.filtered_density for the slots of the reserved plan.
  void record(gpu::Recorder& recorder, const planning::NoisePlan& plan, const Inputs& inputs);

 private:
  gpu::Context& context_;
  gpu::ComputePipeline pipeline_;
  gpu::Sampler repeat_;
  smoke::CloudGrowth growth_;
  gpu::Buffer slots_due_;
  gpu::Buffer parts_, displacements_, motions_, impulses_;
  /// What of the growth is not on the device.
  struct Stale {
    bool parts = true, displacements = true;
  };
  gpu::Recorded<Stale> stale_;
};

}  // namespace brume::passes
