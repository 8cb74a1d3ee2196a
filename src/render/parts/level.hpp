// The level of a frame, as any kind of frame draws it: surfaces, shadow maps, and the light that it lets
// through.
#pragma once

#include "passes/gbuffer.hpp"
#include "passes/indirect_light.hpp"
#include "passes/panes.hpp"
#include "render/parts/frame_part.hpp"
#include "surfaces/light_cells_maker.hpp"

namespace brume::render {

class LevelPart {
 public:
  /// Whose surfaces a frame shows: the scene's or a host's. With a host's, record_gbuffer is not called.
  enum class Surfaces { of_scene, of_host };
  /// Uploads the scene and draws its shadows. All three must outlive the part. Throws resource_limit.
  LevelPart(gpu::Context& context, gpu::CommandStream& stream, const scene::Scene& scene, Surfaces surfaces);

  /// Other lights in the place of the scene's; the next `reserve` draws their shadows. Outside of a
  /// recording, when the device is done with the frame before. Throws resource_limit.
  void set_lights(const std::vector<scene::Light>& lights);
  /// The scene, whose objects and lights are others now: the same in that respect.
  void set_scene(const scene::Scene& scene);
  /// Compiles what frames of indirect light in smoke need.
  void prepare();
  /// Makes room for the level of a plan, and re-renders the shadows of objects that it hides or shows.
  /// Outside of a recording, when the device is done with the frame before. Throws resource_limit.
  void reserve(const FramePlan& plan);
  /// The level of the next plan may be another one of the same layout, or none.
  void invalidate() { solid_.invalidate(); }

  /// Uploads the lights of a plan.
  void upload(gpu::Recorder& recorder, const FramePlan& plan) const;
  /// Updates solid voxels and sky light where the level changed.
  void record_light(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);
  /// Finds the indirect light of a plan, after the upload of its media and the holes in them.
  void record_indirect_light(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);
  /// Draws the surfaces, grenades in the air included.
  void record_gbuffer(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in) const;
  /// Draws the panes over the picture, among `media` and, where they are other images, the tanks of `layers`.
  void record_panes(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                    const gpu::Image& media, const gpu::Image& layers) const;

  bool has_panes() const { return scene_.has_panes; }
  /// Whether the device has the indirect light of the last frame: not where the level of a frame that was
  /// never drawn took its place.
  bool holds_indirect_light() const { return uploaded_levels_.get(context_) == levels_; }
  /// Where indirect light is known; without bounces where there is none.
  shared::IndirectLayout indirect_layout(const FramePlan& plan) const;
  const passes::SceneResources& resources() const { return scene_; }
  const passes::ShadowMaps& shadows() const { return shadows_; }
  passes::LevelLight light() const { return {solid_, sky_light_, indirect_light_.cube()}; }

 private:
  void forget_shadows();
  void reserve_indirect_light(const FramePlan& plan);
  void redraw_shadows(const std::vector<std::uint32_t>& hidden_objects);

  gpu::Context& context_;
  gpu::CommandStream& stream_;
  passes::SceneResources scene_;
  std::optional<passes::GBufferPass> gbuffer_pass_;  ///< Where Surfaces::of_scene.
  std::optional<passes::PanePass> pane_pass_;        ///< Where the scene has panes.
  passes::ShadowPass shadow_pass_;
  passes::ShadowMaps shadows_;
  /// The objects without a shadow in the maps, rising; empty: a failure left the maps undefined.
  std::optional<std::vector<std::uint32_t>> without_shadow_ = std::vector<std::uint32_t>();
  passes::SolidVolume solid_;
  passes::SkyLightPass sky_light_;
  passes::IndirectLightPass indirect_light_;
  surfaces::LightCellsMaker light_cells_maker_;
  surfaces::LightCells light_cells_;  ///< The cells of the last plan with indirect light.
  std::uint64_t levels_ = 0;          ///< Counts levels whose light cells were made.
  gpu::Recorded<std::uint64_t> uploaded_levels_;
};

}  // namespace brume::render
