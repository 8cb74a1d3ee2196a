// Draws a frame: the scene, the smoke of the simulation's present tick, and what a screen shows of them.
#pragma once

#include <functional>
#include <optional>

#include "passes/accumulate.hpp"
#include "passes/debug_view.hpp"
#include "passes/display.hpp"
#include "passes/march.hpp"
#include "passes/noise.hpp"
#include "passes/noise_advection.hpp"
#include "passes/resolve.hpp"
#include "passes/shade.hpp"
#include "passes/sky_light.hpp"
#include "passes/smoke_light.hpp"
#include "passes/smoke_shadow.hpp"
#include "planning/frame_plan.hpp"

namespace brume::render {

using planning::FrameInput;
using planning::FramePlan;

struct RendererOptions {
  glm::uvec2 size_px{1280, 720};            ///< Each in [1, 16384].
  bool count_samples = false;               ///< Count the texture samples of the march (slower).
  bool brute_force_holes = false;           ///< See MarchPass::Options.
  std::uint32_t march_scale = 1;            ///< Pixels per ray of the march along each axis: 1, 2 or 4.
  bool temporal = false;                    ///< Accumulate smoke over the frames of a film (View::continues).
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

  /// Frames of another size from the next one on, each side in [1, 16384]; a film starts over. When the
  /// device is done with what was recorded before. Throws resource_limit.
  void resize(glm::uvec2 size_px);
  /// Other masks of the holes; uploads them. When the device is done with what was recorded before.
  void set_masks(const smoke::MaskAtlas& masks);

  /// Plans a frame and makes room for it; re-renders the shadows where other objects are hidden than before.
  /// Call outside of a recording, when the device is done with the frame before; the frame must then be
  /// recorded. The plan is valid until the next one. Throws resource_limit.
  FramePlan plan(const FrameInput& input);
  /// Records the frame of the last plan. No allocation of device memory besides staging, no submit, no wait.
  void record_frame(gpu::Recorder& recorder, const FramePlan& plan);
  /// Plans and records a frame, and what `then` records after it, and waits until the device has drawn it.
  /// Throws resource_limit.
  void draw(const FrameInput& input, const std::function<void(gpu::Recorder&)>& then = {});

  const gpu::Image& display() const { return display_image_; }  ///< RGBA8, sRGB.
  const gpu::Image& picture() const { return picture_; }        ///< Half floats: radiance.
  /// Half floats: premultiplied radiance, transmittance.
  const gpu::Image& smoke() const { return accumulate_pass_ ? accumulate_pass_->gathered() : smoke_image_; }
  const passes::SmokeResources& smoke_resources() const { return smoke_upload_.resources(); }
  const gpu::Image& depth() const { return gbuffer_.depth; }
  /// The rays of the march; empty where each pixel has its own.
  const std::optional<passes::MarchTiles>& march_tiles() const { return march_tiles_; }
  const gpu::Buffer& sample_counter() const { return counters_; }
  /// What of the light in the smoke the last frame updated.
  const planning::SmokeLightPlan& light_plan() const { return history_.smoke_light.last_plan(); }
  const passes::SceneResources& scene() const { return scene_; }
  glm::uvec2 size_px() const { return size_px_; }

 private:
  planning::PlanTarget plan_target() const;
  void reserve(FramePlan& plan);
  void reserve_debug_view(const FramePlan& plan);

  /// What marches the frame's rays, and where it counts.
  struct March {
    const passes::MarchPass& pass;
    const gpu::Buffer& counters;
    std::uint32_t media;
  };
  March march_of(const FramePlan& plan) const;
  passes::MarchPass::Inputs march_inputs(std::uint32_t media) const;

  void record_upload(gpu::Recorder& recorder, const FramePlan& plan);
  void record_gbuffer(gpu::Recorder& recorder, const FramePlan& plan);
  void record_smoke_shadows(gpu::Recorder& recorder, const FramePlan& plan);
  /// The rays of pixels or of tiles.
  void record_march(gpu::Recorder& recorder, const March& march);
  /// From the rays of tiles to the smoke of every pixel.
  void record_resolve(gpu::Recorder& recorder, const March& march);
  void record_debug_view(gpu::Recorder& recorder, const FramePlan& plan);

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
  std::optional<passes::DebugViewPass> debug_view_;  ///< From the first frame with a debug view on.
  passes::ResolvePass resolve_pass_;
  passes::DisplayPass display_pass_;
  passes::SmokeUpload smoke_upload_;
  passes::VolumeUpload volume_upload_;
  passes::NoiseAdvectionPass noise_advection_pass_;
  passes::SolidVolume solid_;
  passes::SkyLightPass sky_light_;
  passes::ShadowMaps shadows_;
  passes::GBuffer gbuffer_;
  passes::SmokeShadows smoke_shadows_;
  gpu::Image noise_, blue_noise_, smoke_image_, picture_, display_image_;
  std::optional<passes::AccumulatePass> accumulate_pass_;  ///< Where smoke is accumulated over frames.
  std::optional<passes::MarchTiles> march_tiles_;          ///< Where march_scale_ is above 1.
  passes::HoleClusters hole_clusters_;
  gpu::Buffer frame_, counters_;
  planning::PlanHistory history_;
};

}  // namespace brume::render
