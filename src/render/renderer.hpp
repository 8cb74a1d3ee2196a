// Draws a frame: the scene, the smoke of the simulation's present tick, and what a screen shows of them.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "passes/accumulate.hpp"
#include "passes/debug_view.hpp"
#include "passes/display.hpp"
#include "passes/noise_advection.hpp"
#include "passes/march.hpp"
#include "passes/noise.hpp"
#include "passes/resolve.hpp"
#include "passes/shade.hpp"
#include "passes/sky_light.hpp"
#include "passes/smoke_light.hpp"
#include "passes/smoke_shadow.hpp"
#include "scene/scene.hpp"
#include "smoke/smoke_volume.hpp"

namespace brume::render {

/// What one frame shows.
struct FrameInput {
  scene::Camera camera;
  shared::Sky sky{};
  shared::SmokeLook look{};
  float exposure = 1;             ///< Multiplies radiance before the tone curve; > 0.
  float time = 0;                 ///< [s], the clock of the holes and of the drifting noise.
  std::uint32_t frame_index = 0;  ///< Moves jitter and dither; equal numbers give equal pictures.
  passes::LevelView level;        ///< Where the level is solid; of a renderer always the same level.
  const smoke::SmokeVolume* volume = nullptr;  ///< null: no smoke.
  std::span<const shared::Hole> holes;       ///< At most passes::kMaxHoles, the last ones.
  std::vector<shared::Light> flashes;  ///< Lights of the moment; at most passes::kMaxFlashes, the first ones.
  std::vector<glm::mat4> grenades;     ///< world_from_mesh of each grenade in the air.
  /// Whose clouds, shots, bodies and blasts carry the noise; null: it only rises.
  const sim::State* state = nullptr;
  double swirl_period = 12;                   ///< How long the noise takes to roll around once; > 0.
  std::vector<std::uint32_t> hidden_objects;  ///< Of the scene, rising: not drawn, and they cast no shadow.
  /// The next picture of a film: with RendererOptions::temporal the smoke of the frames before counts, too.
  bool continues = false;
  bool rebuild_light =
      false;  ///< Light smoke and surfaces anew even when nothing changed since the last frame.
  /// Multiplies look.step_length, for devices that the usual steps are too much for; > 0. Light in the smoke
  /// is the same with any.
  float step_scale = 1;
  /// Multiplies the error up to which pixels of a reduced march are left to interpolation, three steps of a
  /// display's 255; > 0. Above 1 fewer pixels are marched one by one, and the picture may show what that of
  /// the full march hides.
  float resolve_error_scale = 1;
  /// Of the light in the smoke that is not as it was, about how much is made anew in this frame; in (0, 1],
  /// 1: all. Below, light is as old as ceil(1 / light_update_fraction) frames where it changes slowly, and 1/16 is the
  /// least (passes::SmokeLightCache); such a picture depends on the frames before.
  /// Up to 1/4 shadows of smoke on surfaces are made anew in four frames, and noise that hardly moves is
  /// carried anew in four (passes::NoiseUpdates).
  float light_update_fraction = 1;
  passes::DebugView view = passes::DebugView::none;  ///< What is shown; `display` alone has it.
  /// Where views of density, light and distance cut; empty: passes::slice_through_smoke.
  std::optional<passes::ViewSlice> view_slice;
};

struct RendererOptions {
  glm::uvec2 size_px{1280, 720};          ///< Each in [1, 16384].
  bool count_samples = false;             ///< Count the texture samples of the march (slower).
  bool brute_force_holes = false;               ///< See MarchPass::Options.
  std::uint32_t march_scale = 1;          ///< Pixels per ray of the march along each axis: 1, 2 or 4.
  bool temporal = false;                  ///< Gather smoke over the frames of a film (FrameInput::continues).
  const smoke::MaskAtlas* masks = nullptr;  ///< Of the holes; null: none. Uploaded by the constructor.
};

class Renderer {
 public:
  /// Uploads the scene and draws its shadows. `context` and `runner` must outlive the renderer. Throws
  /// resource_limit when the device has too little memory.
  Renderer(gpu::Context& context, gpu::CommandRunner& runner, const scene::Scene& scene,
           const RendererOptions& options);

  /// Rays of the march from the next frame on, as RendererOptions::march_scale. When the device is done with
  /// what was recorded before. Throws resource_limit.
  void set_march_scale(std::uint32_t scale);

  /// Pictures of another size from the next frame on, each side in [1, 16384]; a film begins anew. When the
  /// device is done with what was recorded before. Throws resource_limit.
  void resize(glm::uvec2 size_px);
  /// Other masks of the holes; uploads them. When the device is done with what was recorded before.
  void set_masks(const smoke::MaskAtlas& masks);

  /// Makes room for the frame's smoke, and draws the shadows anew where other objects are hidden than before:
  /// call before record_frame, outside of a recording, when the device is done with the frame before. Throws
  /// resource_limit.
  void prepare(const FrameInput& input);
  /// Records the whole frame. No allocation of device memory besides staging, no submit, no wait.
  void record_frame(gpu::Recorder& recorder, const FrameInput& input);

  const gpu::Image& display() const { return display_image_; }  ///< RGBA8, sRGB.
  const gpu::Image& picture() const { return picture_; }        ///< Half floats: radiance.
  /// Half floats: premultiplied radiance, transmittance.
  const gpu::Image& smoke() const { return accumulate_pass_ ? accumulate_pass_->gathered() : smoke_image_; }
  const passes::SmokeResources& smoke_resources() const { return smoke_upload_.resources(); }
  const gpu::Image& depth() const { return gbuffer_.depth; }
  /// The rays of the march; empty where each pixel has its own.
  const std::optional<passes::MarchTiles>& march_tiles() const { return blocks_; }
  const gpu::Buffer& sample_counter() const { return counters_; }
  /// What of the light in the smoke the last frame made anew.
  const planning::SmokeLightPlan& light_plan() const { return smoke_light_pass_.plan(); }
  const passes::SceneResources& scene() const { return scene_; }
  glm::uvec2 size_px() const { return size_px_; }

 private:
  void record_smoke_shadows(gpu::Recorder& recorder, const FrameInput& input, bool anew);
  void record_frame_constants(gpu::Recorder& recorder, const FrameInput& input);
  /// What of lights and smoke the frame needs.
  void find_visibility(const FrameInput& input);
  /// Whether the smoke must be lit anew; asks once a frame.
  bool needs_light(const FrameInput& input);

  passes::MarchPass::Inputs march_inputs() const;
  /// What marches the frame's rays, and where it counts.
  struct March {
    const passes::MarchPass& pass;
    const gpu::Buffer& counters;
  };
  March march_of(const FrameInput& input) const;
  /// The rays of pixels or of blocks.
  void record_march(gpu::Recorder& recorder, const March& march);
  /// From the rays of blocks to the smoke of every pixel.
  void record_resolve(gpu::Recorder& recorder, const March& march);

  void follow_hidden_objects(const FrameInput& input);
  void reserve_view(const FrameInput& input);
  void record_view(gpu::Recorder& recorder, const FrameInput& input);

  gpu::Context& context_;
  gpu::CommandRunner& runner_;
  glm::uvec2 size_px_;
  bool brute_force_holes_;
  std::uint32_t march_scale_ = 1;
  passes::SceneResources scene_;
  passes::GBufferPass gbuffer_pass_;
  passes::ShadowPass shadow_pass_;
  passes::SmokeShadowPass smoke_shadow_pass_;
  passes::ShadePass shade_pass_;
  passes::SmokeLightPass smoke_light_pass_;
  passes::MarchPass march_pass_;
  std::optional<passes::MarchPass> counting_march_;  ///< For the view of steps.
  std::optional<passes::DebugViewPass> debug_view_;  ///< From the first frame that is not the picture on.
  passes::ResolvePass resolve_pass_;
  passes::DisplayPass display_pass_;
  passes::SmokeUpload smoke_upload_;
  passes::NoiseAdvectionPass noise_advection_pass_;
  passes::SolidVolume solid_;
  passes::SkyLightPass sky_light_;
  passes::ShadowMaps shadows_;
  passes::GBuffer gbuffer_;
  passes::SmokeShadows smoke_shadows_;
  planning::SmokeShadowPlan smoke_shadow_plan_;  ///< That they were made by.
  /// Frames until they are all made anew, and how many were part of that.
  std::size_t smoke_shadow_turns_ = 0, smoke_shadow_turn_ = 0;
  gpu::Image noise_, blue_noise_, smoke_image_, picture_, display_image_;
  std::optional<passes::AccumulatePass> accumulate_pass_;  ///< Where smoke is gathered over frames.
  std::optional<passes::MarchTiles> blocks_;              ///< Where march_scale_ is above 1.
  passes::HoleClusters hole_clusters_;
  gpu::Buffer frame_, counters_;
  std::vector<shared::Light> lights_;  ///< Of the scene and of the moment, that reach what is in view.
  planning::SmokeVisibility visibility_;
  passes::LevelView lit_level_;   ///< Whose walls kept light away.
  shared::SmokeLook lit_look_{};  ///< The look that the light in the smoke was made with.
  shared::Sky lit_sky_{};
  std::vector<std::uint32_t> hidden_objects_;  ///< That the shadows were drawn without.
  std::vector<shared::Light> lit_flashes_;
  scene::Camera lit_camera_;
  float lit_time_ = 0;
  bool lit_holes_ = false;
  bool noise_changed_ = false;  ///< By the frame, though its moment may be that of the last one.
  bool smoke_changed_ = false;
};

}  // namespace brume::render
