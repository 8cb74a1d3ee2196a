// The smoke of a frame: its bricks, noise, holes, shadows and light.
#pragma once

#include "passes/fine_light.hpp"
#include "passes/noise_advection.hpp"
#include "passes/smoke_light.hpp"
#include "render/parts/frame_part.hpp"

namespace brume::render {

class SmokePart {
 public:
  /// `context` and `stream` must outlive it. `most_lights`: of a frame. Throws resource_limit.
  SmokePart(gpu::Context& context, gpu::CommandStream& stream, std::size_t most_lights, glm::uvec2 size_px,
            const MediaOptions& options);

  // When the device is done with what was recorded before; all throw resource_limit.
  void resize(glm::uvec2 size_px);
  void set_most_lights(std::size_t most_lights, glm::uvec2 size_px);
  /// Other masks of the holes; uploads them.
  void set_masks(const smoke::MaskAtlas& masks);
  /// Gives back what frames grew, but for an atlas of this size: a frame that finds all light again must
  /// follow.
  void trim(glm::ivec3 atlas_bricks);
  void reserve(const FramePlan& plan);

  void upload(gpu::Recorder& recorder, const FramePlan& plan);
  /// The smoke as rays meet it: its noise advected, its holes clustered, the texels that light may reach
  /// listed.
  void record_density(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);
  /// Its shadows on surfaces, and the light in it.
  void record_light(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);

  /// Bricks per axis of the atlas.
  glm::ivec3 atlas_bricks() const { return upload_.atlas_bricks(); }
  planning::SmokeLightRoom light_room() const { return light_pass_.room(); }
  const passes::SmokeResources& resources() const { return upload_.resources(); }
  const passes::HoleResources& holes() const { return hole_clusters_.resources(); }
  const passes::SmokeShadows& shadows() const { return shadows_; }
  const passes::FineLightPass& fine_light() const { return fine_light_pass_; }

 private:
  static passes::SmokeLightPass::Inputs light_inputs(const FrameResources& in);
  void record_shadows(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);

  gpu::Context& context_;
  gpu::CommandStream& stream_;
  std::size_t most_lights_;

  passes::SmokeUpload upload_;
  passes::HoleClusters hole_clusters_;
  passes::NoiseAdvectionPass noise_advection_pass_;
  passes::SmokeShadowPass shadow_pass_;
  passes::SmokeShadows shadows_;
  passes::SmokeLightPass light_pass_;
  passes::FineLightPass fine_light_pass_;
};

}  // namespace brume::render
