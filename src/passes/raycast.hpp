// Raycasting of single volumes, an alternative to the march through all media at once (docs/how/smoke.md).
#pragma once

#include "passes/volume_upload.hpp"
#include "planning/raycast_plan.hpp"

namespace brume::passes {

enum class RaycastForm {
  two_pass,     ///< Interval surfaces by raster of front and back faces, then a pass over the image.
  single_pass,  ///< A ray/box intersection in the fragment shader of the front faces.
};

/// What the target of a RaycastPass is used as.
inline constexpr VkImageUsageFlags kRaycastTargetUsage =
    VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT;

/// Object-space positions where rays enter and leave a volume's box; 0 in alpha where they do not.
struct IntervalSurfaces {
  gpu::Image entries, exits;  ///< Floats.
  IntervalSurfaces(gpu::Context& context, glm::uvec2 size_px);
};

class RaycastPass {
 public:
  /// Its pipelines, and for two_pass the interval surfaces. Throws resource_limit.
  RaycastPass(gpu::Context& context, RaycastForm form, glm::uvec2 size_px);

  struct Inputs {
    VolumeResources volumes;
    const gpu::Image& depth;  ///< GBuffer::depth: rays end there.
  };
  /// Draws the volumes of the plan, whose instances `inputs` holds in the same order. `target`, of
  /// half floats and with kRaycastTargetUsage, holds premultiplied radiance and transmittance then: what a
  /// MarchPass writes.
  void record(gpu::Recorder& recorder, const Inputs& inputs, const planning::RaycastPlan& plan,
              const gpu::Image& target) const;

  /// Interval surfaces of the last volume drawn; only for two_pass.
  const IntervalSurfaces& surfaces() const { return *surfaces_; }

 private:
  void record_two_pass(gpu::Recorder& recorder, const Inputs& inputs, const planning::RaycastPlan::Box& box,
                       const gpu::Image& target) const;
  void record_single_pass(gpu::Recorder& recorder, const Inputs& inputs, const planning::RaycastPlan& plan,
                          const gpu::Image& target) const;
  void draw_surface(gpu::Recorder& recorder, const shared::RaycastDraw& draw,
                    const gpu::Image& surface) const;

  std::optional<gpu::GraphicsPipeline> interval_, single_;
  std::optional<gpu::ComputePipeline> two_pass_;
  std::optional<IntervalSurfaces> surfaces_;
  gpu::Buffer view_, volumes_;
  gpu::Sampler nearest_;
};

}  // namespace brume::passes
