// Draws frames. Each kind of frame calls the parts (parts/frame_part.hpp) in an order of its own.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "planning/frame_plan.hpp"
#include "render/parts/decals.hpp"
#include "render/parts/host_surfaces.hpp"
#include "render/parts/level.hpp"
#include "render/parts/march.hpp"
#include "render/parts/motion.hpp"
#include "render/parts/picture.hpp"
#include "render/parts/smoke.hpp"
#include "render/parts/tanks.hpp"
#include "render/parts/volumes.hpp"
#include "render/smoke_budget.hpp"

namespace brume::render {

struct RendererOptions {
  glm::uvec2 size_px{1280, 720};  ///< Each in [1, 16384].
  MediaOptions smoke{};
  /// Smooths edges over the frames of a film (View::continues), each of which samples another point of every
  /// pixel (planning::film_sample).
  bool antialias = false;
  /// The surfaces are a host's. Frames are recorded by record_over alone, without particles or debug views.
  bool media_alone = false;
  bool motion = false;  ///< Where media_alone: motion() of each frame. Needs MediaOptions::record_entries.
};

/// A frame over the surfaces of a host.
struct HostFrame {
  HostSurfaces surfaces;
  /// Lights whose shadows the host asks for, at most four (HostSurfacesPart::record_shadows).
  std::span<const std::uint32_t> shadow_lights = {};
  const gpu::Image* picture = nullptr;  ///< The host's picture, over which the layers are drawn; null: none.
  float exposure = 1;                   ///< Multiplies the layers over the picture.
};

class Renderer {
 public:
  /// Uploads the scene and draws its shadows. `context`, `stream` and `scene`, which must not change, must
  /// outlive the renderer. Throws resource_limit when the device has too little memory.
  Renderer(gpu::Context& context, gpu::CommandStream& stream, const scene::Scene& scene,
           const RendererOptions& options);

  /// Changes MediaOptions::march_scale from the next frame on. Call when the device has finished all recorded
  /// frames. Throws resource_limit.
  void set_march_scale(std::uint32_t scale);
  /// Changes the size of frames from the next one on, each side in [1, 16384]; a film starts over. Call when
  /// the device has finished all recorded frames. Throws resource_limit.
  void resize(glm::uvec2 size_px);
  /// Replaces the masks of the holes and uploads them. Call when the device has finished all recorded frames.
  void set_masks(const smoke::MaskAtlas& masks);

  /// Replaces the scene's lights from the next frame on, which computes all light again. Call when the device
  /// has finished all recorded frames. Throws resource_limit.
  void set_lights(const std::vector<scene::Light>& lights);
  /// The same where objects, too, are others than the scene had.
  void set_scene(const scene::Scene& scene);

  /// Makes the next frame compute all light again, whatever is cached: call it when the next frame's smoke is
  /// another SmokeVolume than before.
  void invalidate();
  /// The same, for a next frame whose level may also be another one, or none.
  void invalidate_level();

  /// Plans a frame and makes room for it; re-renders the shadows where other objects are hidden than before.
  /// Call outside of a recording, when the device has finished the previous frame. The plan is valid until
  /// the next one, and no longer than `input`, to which it refers. A frame that is not recorded, or whose
  /// recording is dropped, leaves nothing behind. Where memory is short, smoke becomes coarser: see
  /// smoke_level(). Throws resource_limit where that does not help, and bad_input for volumes and particles
  /// that FrameInput does not allow.
  FramePlan plan(const FrameInput& input);
  FramePlan plan(FrameInput&& input) = delete;
  /// Records the frame of the last plan. Allocates no device memory besides staging; neither submits nor
  /// waits.
  void record_frame(gpu::Recorder& recorder, const FramePlan& plan);
  /// The same in kParts steps (the light, the march, the picture), which may be submitted one by one. After
  /// the first one the others may be omitted: then the targets hold nothing of use, and the next frame does
  /// not continue a film.
  void record_part(gpu::Recorder& recorder, const FramePlan& plan, int part);
  static constexpr int kParts = 3;
  /// The same for a volume that is split among several renderers, of which this one has a part
  /// (VolumePartRenderer): first the optical depths that its light needs, then light and rays, then the
  /// picture.
  void record_sweeps(gpu::Recorder& recorder, const FramePlan& plan);
  void record_rays(gpu::Recorder& recorder, const FramePlan& plan);
  void record_picture(gpu::Recorder& recorder, const FramePlan& plan);
  /// Plans and records a frame, and what `then` records after it, and waits until the device has drawn it.
  /// Throws as `plan`.
  void draw(const FrameInput& input, const std::function<void(gpu::Recorder&)>& then = {});

  // Where RendererOptions::media_alone:
  /// What a frame over a host's surfaces needs room for, however little of it is in view.
  struct HostNeeds {
    std::uint32_t view = 0;  ///< View::index.
    bool decals = false, shadows = false, tanks = false;
    bool samples = false;                    ///< passes::HostDepthRange::has_samples.
    VkFormat picture = VK_FORMAT_UNDEFINED;  ///< The format of HostFrame::picture.
  };
  /// Makes room for `needs`, as `plan` does for the rest. Call without a limit of memory
  /// (gpu::Memory::Unlimited).
  void reserve_over(const HostNeeds& needs);
  /// Records the media and tanks of the last plan in front of a host's surfaces, into layers(), the decals on
  /// those surfaces, and what the host asks for: shadows, and the layers over its picture.
  void record_over(gpu::Recorder& recorder, const FramePlan& plan, const HostFrame& host);

  const Targets& targets() const { return targets_; }
  /// FrameConstants of the last frame.
  const gpu::Buffer& frame() const { return frame_; }
  /// Half floats: premultiplied radiance and transmittance of the media.
  const gpu::Image& media() const { return march_.result(targets_); }
  /// The same of media and tanks together, in front of the surfaces of the level or of a host.
  const gpu::Image& layers() const;
  /// Reverse depth of the last plan's surfaces, tanks included.
  const gpu::Image& surfaces() const;
  /// The last frame's shadows, half floats: see SurfaceShadowPass. Null: it had no shadow_lights.
  const gpu::Image* shadows() const;
  /// The motion of the last frame's media (SmokeMotionPass). Null: RendererOptions::motion is not set.
  const gpu::Image* motion() const { return motion_ ? &motion_->motion() : nullptr; }
  /// Half floats: radiance of the picture before exposure and tone curve.
  const gpu::Image& radiance() const { return picture_->radiance(targets_); }
  bool is_antialiased() const { return picture_ && picture_->is_antialiased(); }
  /// Whether the last frame had decals, in view or not.
  bool has_decals() const { return decals_.has_decals(); }
  /// Half floats: in red, which fraction of their light the surfaces of the last frame lost to decals. Null
  /// where none was in view; over a host's surfaces, where there was none.
  const gpu::Image* occlusion() const { return decals_.occlusion(); }
  /// How coarse the smoke of the last frame is for want of memory: its voxels are 2^level voxels of the
  /// simulation wide.
  int smoke_level() const { return recorded_.get(context_).smoke_level; }
  /// Whether smoke out of view dims less light than it should, for want of memory.
  bool is_smoke_missing() const { return recorded_.get(context_).is_smoke_missing; }
  /// Whether volumes of the last frame have bricks that are still to be uploaded.
  bool streams_volumes() const { return !history_.volume_streaming.complete(); }
  /// Which light in the smoke the last frame updated.
  const planning::SmokeLightPlan& light_plan() const { return history_.smoke_light.last_plan(); }

  const LevelPart& level() const { return level_; }
  const SmokePart& smoke() const { return smoke_; }
  const VolumesPart& volumes() const { return volumes_; }
  const MarchPart& march() const { return march_; }

 private:
  void forget_light();
  bool holds_all_smoke() const { return !memory_follows_view_ && smoke_budget_.is_unlimited(); }
  glm::uvec2 size_of(const FrameInput& input) const;
  planning::PlanTarget plan_target(const FrameInput& input) const;
  void commit_recorded();
  FramePlan try_plan(const FrameInput& input);
  void reserve(const FramePlan& plan);
  FrameResources resources(const FramePlan& plan) const;
  void upload(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);
  void record_until_sweeps(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                           const HostSurfaces* host);
  void record_on_host(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                      const HostSurfaces& host);
  void record_light(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in,
                    const HostSurfaces* host);
  void record_march(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);
  void record_picture(gpu::Recorder& recorder, const FramePlan& plan, const FrameResources& in);

  gpu::Context& context_;
  gpu::CommandStream& stream_;
  Targets targets_;
  gpu::Image blue_noise_;
  gpu::Buffer frame_;

  // The parts of a frame.
  LevelPart level_;
  SmokePart smoke_;
  VolumesPart volumes_;
  MarchPart march_;
  SlicesPart slices_;
  DecalsPart decals_;
  ParticlesPart particles_;
  std::optional<PicturePart> picture_;    ///< Without RendererOptions::media_alone: shows our own surfaces.
  std::optional<MotionPart> motion_;      ///< Where RendererOptions::motion.
  std::optional<HostSurfacesPart> host_;  ///< With it: takes a host's surfaces.
  std::optional<TanksPart> tanks_;        ///< Empty until the first frame with tanks.

  SmokeBudget smoke_budget_;
  const bool memory_follows_view_;
  planning::PlanHistory history_;
  /// The last frame whose commands were recorded.
  struct Recorded {
    std::uint64_t plan = 0;  ///< FramePlan::number; 0: there was no frame.
    int smoke_level = 0;
    bool is_smoke_missing = false, has_shadows = false;
  };
  gpu::Recorded<Recorded> recorded_;
};

}  // namespace brume::render
