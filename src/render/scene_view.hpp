// A scene on the device, as any kind of frame draws it: surfaces, shadow maps, and the light that the level
// lets through.
#pragma once

#include "passes/gbuffer.hpp"
#include "passes/shade.hpp"
#include "planning/frame_plan.hpp"

namespace brume::render {

class SceneView {
 public:
  /// Uploads the scene and draws its shadows. `context` and `runner` must outlive the view. Throws
  /// resource_limit.
  SceneView(gpu::Context& context, gpu::CommandRunner& runner, const scene::Scene& scene);

  /// Makes room for the level of a plan, and re-renders the shadows of objects that it hides or shows.
  /// Outside of a recording, when the device is done with the frame before. Throws resource_limit.
  void reserve(const planning::FramePlan& plan);

  /// Uploads the lights of a plan.
  void record_lights(gpu::Recorder& recorder, const planning::FramePlan& plan) const;
  /// Updates solid voxels and sky light where the level changed. `frame` holds FrameConstants, here and
  /// below.
  void record_level(gpu::Recorder& recorder, const planning::FramePlan& plan, const gpu::Buffer& frame);
  /// Draws the surfaces, grenades in the air included.
  void record_gbuffer(gpu::Recorder& recorder, const planning::FramePlan& plan, const gpu::Buffer& frame,
                      const passes::GBuffer& target) const;

  const passes::SceneResources& resources() const { return scene_; }
  const passes::ShadowMaps& shadows() const { return shadows_; }
  passes::LevelLight level() const { return {solid_, sky_light_}; }

 private:
  gpu::Context& context_;
  gpu::CommandRunner& runner_;
  passes::SceneResources scene_;
  passes::GBufferPass gbuffer_pass_;
  passes::ShadowPass shadow_pass_;
  passes::ShadowMaps shadows_;
  passes::SolidVolume solid_;
  passes::SkyLightPass sky_light_;
};

}  // namespace brume::render
