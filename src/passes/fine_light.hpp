// Light in the smoke near the eye, with the shadows of noise within a voxel (shared/fine_light.h).
#pragma once

#include "passes/smoke_upload.hpp"
#include "planning/fine_light_plan.hpp"

namespace brume::passes {

class FineLightPass {
 public:
  explicit FineLightPass(gpu::Context& context);

  struct Inputs {
    const gpu::Buffer& frame;
    const SmokeResources& smoke;
    const gpu::Image& noise;
  };
  /// Makes room for the pages of a plan; where there is no memory for all of them, for the first ones, which
  /// alone are filled. When SmokeUpload::reserve may be called. Throws resource_limit.
  void reserve(const planning::FineLightPlan& plan);
  /// Gives back the memory of what `reserve` makes room for, before it is called the next time.
  void trim();
  /// Uploads the reserved plan.
  void upload(gpu::Recorder& recorder, const planning::FineLightPlan& plan) const;
  /// Fills the pages of the reserved plan from the smoke's light and density.
  void record(gpu::Recorder& recorder, const planning::FineLightPlan& plan, const Inputs& inputs) const;

  // References stay valid; the resources that they refer to are replaced by `reserve`.
  const gpu::Image& light() const { return light_; }
  const gpu::Buffer& pages() const { return pages_; }

 private:
  gpu::Context& context_;
  gpu::ComputePipeline pipeline_;
  gpu::Sampler repeat_;
  gpu::Image light_;
  gpu::Buffer pages_, slots_;
  std::uint32_t page_count_ = 0;  ///< Pages of the plan that was reserved.
};

}  // namespace brume::passes
