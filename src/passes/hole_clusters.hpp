// Culling of holes (shared/hole_clusters.h), repeated each frame because holes open and close.
#pragma once

#include "passes/hole_masks.hpp"
#include "passes/smoke_upload.hpp"
#include "planning/hole_plan.hpp"
#include "shared/hole_clusters.h"

namespace brume::passes {

/// Holes on the device, for every pass that evaluates them.
struct HoleResources {
  const gpu::Sampler& nearest;
  gpu::Buffer holes{};    ///< shared::PackedHole.
  gpu::Buffer reaches{};  ///< shared::PackedReach, one per hole.
  gpu::Buffer lists{}, cells{};
  gpu::Image masks{};  ///< The mask atlas.
  bool any = false;    ///< Whether any hole of the frame may remove smoke.

  /// All that shaders read of the holes.
  auto bindings() const {
    return std::to_array<gpu::BoundResource>({
        {shared::kBindHoles, gpu::read(holes)},
        {shared::kBindHoleReaches, gpu::read(reaches)},
        {shared::kBindHoleLists, gpu::read(lists)},
        {shared::kBindHoleCells, gpu::read(cells)},
        {shared::kBindHoleMasks, gpu::sampled(masks, nearest)},
    });
  }
};

class HoleClusters {
 public:
  /// Uploads the masks.
  HoleClusters(gpu::Context& context, gpu::CommandStream& stream, const smoke::MaskAtlas& masks);
  /// Other masks instead. When the device is done with what was recorded before.
  void set_masks(gpu::Context& context, gpu::CommandStream& stream, const smoke::MaskAtlas& masks);

  /// Makes room for a plan. Not between the begin and the end of a recording, and only when the device is
  /// done with what it recorded before. Throws resource_limit.
  void reserve(const planning::HolePlan& plan);
  /// Uploads the holes of the reserved plan.
  void upload(gpu::Recorder& recorder, const planning::HolePlan& plan);
  /// Clusters them in two steps, after the frame's constants, which have the plan's layout, and the smoke
  /// were uploaded. The dispatches of a step are independent (gpu::Recorder::concurrently).
  void record_first(gpu::Recorder& recorder, const planning::HolePlan& plan, const gpu::Buffer& frame,
                    const SmokeResources& smoke);
  void record_second(gpu::Recorder& recorder, const planning::HolePlan& plan, const gpu::Buffer& frame,
                     const SmokeResources& smoke);
  /// All of it, where nothing else runs beside a step.
  void record(gpu::Recorder& recorder, const planning::HolePlan& plan, const gpu::Buffer& frame,
              const SmokeResources& smoke);

  const HoleResources& resources() const { return resources_; }

 private:
  gpu::Context& context_;
  gpu::ComputePipeline tiles_pass_, groups_pass_, bricks_pass_, cells_pass_;
  gpu::Sampler nearest_;
  HoleResources resources_;
  gpu::Buffer coarse_tile_holes_, pairs_, counters_, words_taken_;
};

}  // namespace brume::passes
