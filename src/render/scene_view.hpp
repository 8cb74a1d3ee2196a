// A scene on the device, as any kind of frame draws it: surfaces, shadow maps, and the light that the level
// lets through.
#pragma once

#include "passes/gbuffer.hpp"
#include "passes/indirect_light.hpp"
#include "passes/panes.hpp"
#include "passes/shade.hpp"
#include "planning/frame_plan.hpp"

namespace brume::render {

class SceneView {
 public:
  /// Uploads the scene and draws its shadows. All three must outlive the view. Throws
  /// resource_limit.
  SceneView(gpu::Context& context, gpu::CommandStream& stream, const scene::Scene& scene);

  /// Makes room for the level of a plan, and re-renders the shadows of objects that it hides or shows.
  /// Outside of a recording, when the device is done with the frame before. Throws resource_limit.
  void reserve(const planning::FramePlan& plan);
  /// The level of the next plan may be another one of the same layout, or none.
  void invalidate_level() { solid_.invalidate(); }

  /// Uploads the lights of a plan.
  void record_lights(gpu::Recorder& recorder, const planning::FramePlan& plan) const;
  /// Updates solid voxels and sky light where the level changed. `frame` holds FrameConstants, here and
  /// below.
  void record_level(gpu::Recorder& recorder, const planning::FramePlan& plan, const gpu::Buffer& frame);
  /// Finds the indirect light of a plan, after the upload of its media and the holes in them.
  struct MediaResources {
    const passes::SmokeResources& smoke;
    const gpu::Buffer& hole_cells;
    const gpu::Image& noise;  ///< Its tile.
    passes::VolumeResources volumes;
    const gpu::Image& glow_field;  ///< GlowFieldPass::field.
  };
  void record_indirect_light(gpu::Recorder& recorder, const planning::FramePlan& plan,
                             const gpu::Buffer& frame, const MediaResources& media);
  /// Where indirect light is known; without bounces where there is none.
  shared::IndirectLayout indirect_layout(const planning::FramePlan& plan) const;
  /// Draws the surfaces, grenades in the air included.
  void record_gbuffer(gpu::Recorder& recorder, const planning::FramePlan& plan, const gpu::Buffer& frame,
                      const passes::GBuffer& target) const;

  /// Draws the panes over the picture. Where has_panes().
  void record_panes(gpu::Recorder& recorder, const planning::FramePlan& plan,
                    const passes::PanePass::Inputs& in, const gpu::Image& radiance) const;
  bool has_panes() const { return scene_.has_panes; }

  const passes::SceneResources& resources() const { return scene_; }
  const passes::ShadowMaps& shadows() const { return shadows_; }
  passes::LevelLight level() const { return {solid_, sky_light_, indirect_light_.cube()}; }

 private:
  void reserve_indirect_light(const planning::FramePlan& plan);

  gpu::Context& context_;
  gpu::CommandStream& stream_;
  const scene::Scene* source_;
  passes::SceneResources scene_;
  passes::GBufferPass gbuffer_pass_;
  std::optional<passes::PanePass> pane_pass_;  ///< Where the scene has panes.
  passes::ShadowPass shadow_pass_;
  passes::ShadowMaps shadows_;
  passes::SolidVolume solid_;
  passes::SkyLightPass sky_light_;
  passes::IndirectLightPass indirect_light_;
  reference::LightCells light_cells_;  ///< Of the last plan with indirect light.
};

}  // namespace brume::render
