// Draws a frame: the scene, the media of the simulation's present tick, and what a screen shows of them.
#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "passes/antialias.hpp"
#include "passes/average.hpp"
#include "passes/debug_view.hpp"
#include "passes/decals.hpp"
#include "passes/display.hpp"
#include "passes/particles.hpp"
#include "passes/slice_textures.hpp"
#include "passes/surface_import.hpp"
#include "planning/frame_plan.hpp"
#include "render/smoke_budget.hpp"
#include "render/smoke_frame.hpp"

namespace brume::render {

using planning::FrameInput;
using planning::FramePlan;
class TankLayer;

struct RendererOptions {
  glm::uvec2 size_px{1280, 720};  ///< Each in [1, 16384].
  SmokeFrameOptions smoke{};
  /// Smooths edges over the frames of a film (View::continues), each of which shows another point of every
  /// pixel (planning::film_sample).
  bool antialias = false;
  /// The surfaces are a host's: frames are recorded by record_media_over alone, and there are no particles
  /// and debug views.
  bool media_alone = false;
};

/// The surfaces that a host drew for a frame, from its camera.
struct HostSurfaces {
  const gpu::Image& depth;  ///< Of the renderer's size.
  passes::HostDepthRange range;
  passes::HostNormals normals = {};  ///< For decals.
  TankLayer* tanks = nullptr;        ///< Planned for this frame, surfaces, too; null: none.
};

class Renderer {
 public:
  /// Uploads the scene and draws its shadows. `context`, `stream` and `scene`, which must not change, must
  /// outlive the renderer. Throws resource_limit when the device has too little memory.
  Renderer(gpu::Context& context, gpu::CommandStream& stream, const scene::Scene& scene,
           const RendererOptions& options);

  /// Rays of the march from the next frame on, as SmokeFrameOptions::march_scale. When the device is done
  /// with what was recorded before. Throws resource_limit.
  void set_march_scale(std::uint32_t scale);

  /// Frames of another size from the next one on, each side in [1, 16384]; a film starts over. When the
  /// device is done with what was recorded before. Throws resource_limit.
  void resize(glm::uvec2 size_px);
  /// Other masks of the holes; uploads them. When the device is done with what was recorded before.
  void set_masks(const smoke::MaskAtlas& masks);

  /// The next frame finds all light again, whatever is cached. For a frame that was planned and not recorded,
  /// and for smoke that is another SmokeVolume than before.
  void invalidate();
  /// The same, and the next frame's level may be another one, or none.
  void invalidate_level();

  /// Plans a frame and makes room for it; re-renders the shadows where other objects are hidden than before.
  /// Call outside of a recording, when the device is done with the frame before; the frame must then be
  /// recorded. The plan is valid until the next one. Where memory is short, smoke becomes coarser: see
  /// smoke_level(). Throws resource_limit where that does not help, and bad_input for volumes and
  /// particles that FrameInput does not allow; the next frame then updates everything.
  FramePlan plan(const FrameInput& input);
  /// Records the frame of the last plan. No allocation of device memory besides staging, no submit, no wait.
  void record_frame(gpu::Recorder& recorder, const FramePlan& plan);
  /// The same in kParts parts, which may be submitted one by one. After the first one the others may be
  /// omitted: then the targets hold nothing of use, and the next frame does not continue a film.
  void record_part(gpu::Recorder& recorder, const FramePlan& plan, int part);
  static constexpr int kParts = 3;
  /// The same frame of a part of a volume, of which other renderers have the others (VolumePartRenderer):
  /// first the optical depths of its light, then its light and rays, then the picture.
  void record_sweeps(gpu::Recorder& recorder, const FramePlan& plan);
  void record_rays(gpu::Recorder& recorder, const FramePlan& plan);
  void record_picture(gpu::Recorder& recorder, const FramePlan& plan);
  /// Makes room for decals, as `plan` does where there are any: for frames whose images no limit refuses.
  void reserve_decals();
  /// Records the media of the last plan in front of a host's surfaces, media(), and the decals on them,
  /// occlusion(). Where RendererOptions::media_alone.
  void record_media_over(gpu::Recorder& recorder, const FramePlan& plan, const HostSurfaces& surfaces);
  /// Plans and records a frame, and what `then` records after it, and waits until the device has drawn it.
  /// Throws as `plan`.
  void draw(const FrameInput& input, const std::function<void(gpu::Recorder&)>& then = {});

  const Targets& targets() const { return targets_; }
  /// FrameConstants of the last frame.
  const gpu::Buffer& frame() const { return frame_; }
  /// Half floats: premultiplied radiance and transmittance of the media.
  const gpu::Image& media() const { return smoke_.result(targets_); }
  /// Half floats: radiance of the picture before exposure and tone curve.
  const gpu::Image& radiance() const {
    return antialias_pass_ ? antialias_pass_->result() : targets_.radiance;
  }
  bool is_antialiased() const { return antialias_pass_.has_value(); }
  const SmokeFrame& smoke() const { return smoke_; }
  const SceneView& scene() const { return scene_; }
  /// Whether the last frame had decals, in view or not.
  bool has_decals() const { return has_decals_; }
  /// Half floats: in red, which fraction of their light the surfaces of the last frame lost to decals. Null
  /// where none was in view; over a host's surfaces, where there was none.
  const gpu::Image* occlusion() const { return occlusion_; }
  /// How coarse the smoke of the last frame is for want of memory: its voxels are 2^level voxels of the
  /// simulation wide.
  int smoke_level() const { return holds_all_smoke() ? 0 : history_.resident->level(); }
  /// Whether smoke out of view dims less light than it should, for want of memory.
  bool is_smoke_missing() const { return !holds_all_smoke() && history_.resident->is_missing(); }
  /// Whether volumes of the last frame have bricks that are still to be uploaded.
  bool streams_volumes() const { return !history_.volume_streaming.complete(); }
  /// What of the light in the smoke the last frame updated.
  const planning::SmokeLightPlan& light_plan() const { return history_.smoke_light.last_plan(); }

 private:
  bool holds_all_smoke() const { return !memory_follows_view_ && smoke_budget_.is_unlimited(); }
  planning::PlanTarget plan_target() const;
  void upload_volumes(const FrameInput& input);
  void upload_slices(const FrameInput& input);
  FramePlan try_plan();
  void reserve(FramePlan& plan);
  void upload_decals(gpu::Recorder& recorder, const FramePlan& plan);
  void begin_decals(const FramePlan& plan, bool shows);
  void record_decals(gpu::Recorder& recorder, const FramePlan& plan);
  void record_on_surfaces(gpu::Recorder& recorder, const FramePlan& plan, const HostSurfaces& host);
  void record_decals_on(gpu::Recorder& recorder, const FramePlan& plan, const passes::HostNormals& normals);
  void record_upload(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);
  FrameResources resources(const FramePlan& plan);
  void record_surfaces(gpu::Recorder& recorder, const FramePlan& plan, const HostSurfaces* host);
  void record_light(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                    const HostSurfaces* host);
  void record_until_sweeps(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                           const HostSurfaces* host);
  void record_media(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);
  void record_accumulate(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);
  void record_image(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);
  void record_panes(gpu::Recorder& recorder, const FramePlan& plan);
  void record_particles(gpu::Recorder& recorder, const FramePlan& plan);
  void record_antialias(gpu::Recorder& recorder, const FramePlan& plan);
  void record_debug_view(gpu::Recorder& recorder, const FramePlan& plan);

  gpu::Context& context_;
  gpu::CommandStream& stream_;
  SceneView scene_;
  Targets targets_;
  SmokeFrame smoke_;
  SmokeBudget smoke_budget_;
  const bool memory_follows_view_;
  std::optional<passes::SurfaceImport> surface_import_;  ///< Where RendererOptions::media_alone, and else:
  std::optional<passes::ShadePass> shade_pass_;
  const bool shading_displays_;
  std::optional<passes::DisplayPass>
      display_pass_;  ///< From the first frame on that is not displayed as it is shaded.
  std::optional<passes::DecalPass> decal_pass_;           ///< From the first frame with decals on.
  std::optional<passes::SurfaceNormalPass> normal_pass_;  ///< Likewise, of a host's surfaces.
  bool has_decals_ = false;
  const gpu::Image* occlusion_ = nullptr;
  std::optional<passes::SliceTextures> slices_;
  std::shared_ptr<const grids::DenseVolumes> loaded_slices_;  ///< What `slices_` holds.
  std::optional<passes::DebugViewPass> debug_view_;           ///< From the first frame with a debug view on.
  std::optional<passes::AntialiasPass> antialias_pass_;       ///< Where RendererOptions::antialias.
  std::optional<passes::AveragePass> average_pass_;    ///< From the first picture of several frames on.
  std::optional<passes::ParticlePass> particle_pass_;  ///< From the first frame with particles in view.
  gpu::Image blue_noise_;
  gpu::Buffer frame_;
  planning::PlanHistory history_;
  FrameInput input_;                                  // of the last plan, which refers to it
  std::uint64_t plan_number_ = 0;                     // of the plan that is valid
  std::vector<std::uint32_t> hidden_objects_before_;  // the last plan, for one that fails
};

}  // namespace brume::render
