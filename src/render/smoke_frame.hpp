// What the media of a frame add to it: the smoke with its noise, holes, light and shadows, the volumes, and
// the march through all of them.
#pragma once

#include <optional>

#include "passes/accumulate.hpp"
#include "passes/fine_light.hpp"
#include "passes/glow_field.hpp"
#include "passes/march.hpp"
#include "passes/noise_advection.hpp"
#include "passes/raycast.hpp"
#include "passes/resolve.hpp"
#include "passes/smoke_light.hpp"
#include "passes/smoke_shadow.hpp"
#include "passes/volume_light.hpp"
#include "render/scene_view.hpp"
#include "render/targets.hpp"

namespace brume::render {

struct SmokeFrameOptions {
  bool count_samples = false;      ///< Count the texture samples of the march (slower).
  bool brute_force_holes = false;  ///< See MarchPass::Options.
  std::uint32_t march_scale = 1;   ///< Pixels per ray of the march along each axis: 1, 2 or 4.
  /// Prepares at once what any later frame may need, so that none waits for it: pipelines of all march
  /// scales, the noise of smoke. Otherwise each is prepared for the first frame that needs it.
  bool prepare_all = false;
  /// Draws the volumes alone, one by one, without light from each other; needs march_scale 1.
  std::optional<passes::RaycastForm> raycast = {};
  bool temporal = false;                    ///< Accumulate smoke over the frames of a film (View::continues).
  const smoke::MaskAtlas* masks = nullptr;  ///< Of the holes; null: none. Uploaded by the constructor.
  bool record_entries = false;              ///< See MarchPass::Options: into march_counters().
  /// The device holds the smoke that is in view, not all of it. Pictures then depend on the frames before by
  /// the rounding of places in the atlas.
  bool memory_follows_view = false;
  /// Bricks of smoke that there is always memory for, as of volume::grown_atlas.
  std::uint32_t reserved_bricks = 64;
};

/// What a frame gives to each of its steps.
struct FrameResources {
  const gpu::Buffer& frame;  ///< FrameConstants.
  const SceneView& scene;
  const Targets& targets;
  const gpu::Image& blue_noise;
  /// Where the march counts the steps of each pixel (MarchPass::Options::count_steps); null: nowhere.
  const gpu::Buffer* step_counters = nullptr;
};

/// Its record_ functions run in this order. They allocate no device memory besides staging, and neither
/// submit nor wait. What needs room outside of a recording says so.
class SmokeFrame {
 public:
  /// `context` and `stream` must outlive it. Throws resource_limit.
  SmokeFrame(gpu::Context& context, gpu::CommandStream& stream, const SceneView& scene, glm::uvec2 size_px,
             const SmokeFrameOptions& options);

  // When the device is done with what was recorded before; all throw resource_limit.
  /// Frames of another size; what was accumulated is dropped.
  void resize(const SceneView& scene, glm::uvec2 size_px);
  /// Rays of the march, as SmokeFrameOptions::march_scale.
  void set_march_scale(std::uint32_t scale);
  /// Other masks of the holes; uploads them.
  void set_masks(const smoke::MaskAtlas& masks);
  /// Makes room for the volumes of a frame, before it is planned. Returns those of which nothing is on the
  /// device (SparseVolume::id). Throws resource_limit.
  std::vector<std::uint64_t> reserve_volumes(std::span<const planning::VolumeInput> volumes) {
    return volume_upload_.reserve(volumes);
  }
  /// Uploads a part of large volumes, before the frame that they are shown in.
  void record_volume_part(gpu::Recorder& recorder, std::span<const planning::VolumeInput> volumes,
                          std::span<const planning::VolumeResidency> part) {
    volume_upload_.record_part(recorder, volumes, part);
  }
  /// Gives back what frames grew, but for an atlas of this size: a frame that finds all light again must
  /// follow.
  void trim(glm::ivec3 atlas_bricks);
  /// Bricks per axis of the smoke's atlas.
  glm::ivec3 atlas_bricks() const { return smoke_upload_.atlas_bricks(); }
  /// Makes room for a plan; plans the light again where the device lost what was cached of it.
  void reserve(planning::FramePlan& plan, planning::PlanHistory& history);

  void record_upload(gpu::Recorder& recorder, const planning::FramePlan& plan, const FrameResources& in);
  /// The smoke as rays meet it: its noise advected, its holes clustered, the texels that light may reach
  /// listed.
  void record_density(gpu::Recorder& recorder, const planning::FramePlan& plan, const FrameResources& in);
  /// The smoke's shadows on surfaces, and the light in it.
  void record_light(gpu::Recorder& recorder, const planning::FramePlan& plan, const FrameResources& in);
  /// The light of what glows in volumes, in the volumes themselves.
  void record_glow(gpu::Recorder& recorder, const planning::FramePlan& plan) const;
  /// The light in the volumes: their sweeps, then the rest.
  void record_volume_sweeps(gpu::Recorder& recorder, const planning::FramePlan& plan,
                            const FrameResources& in);
  void record_volume_light(gpu::Recorder& recorder, const planning::FramePlan& plan,
                           const FrameResources& in);
  /// The rays of pixels or of tiles.
  void record_march(gpu::Recorder& recorder, const planning::FramePlan& plan, const FrameResources& in);
  /// From the rays of tiles to every pixel. Where march_tiles() has a value.
  void record_resolve(gpu::Recorder& recorder, const planning::FramePlan& plan, const FrameResources& in);
  /// The mean over frames. Where is_accumulated().
  void record_accumulate(gpu::Recorder& recorder, const planning::FramePlan& plan, const FrameResources& in);

  /// Premultiplied radiance and transmittance of each pixel.
  const gpu::Image& result(const Targets& targets) const {
    return accumulate_pass_ ? accumulate_pass_->gathered() : targets.media;
  }
  std::uint32_t march_scale() const { return march_scale_; }
  bool is_accumulated() const { return accumulate_pass_.has_value(); }
  const passes::SmokeResources& resources() const { return smoke_upload_.resources(); }
  /// The volumes as light is found in them.
  passes::VolumeResources lit_volumes() const { return volume_upload_.lit_resources(); }
  const gpu::Image& glow_field() const { return glow_field_pass_.field(); }
  /// What the light in the volumes is found from.
  const passes::VolumeLightPass& volume_light() const { return volume_light_pass_; }
  /// The tile of its noise, from the first frame with smoke on.
  const gpu::Image& noise() const { return noise_; }
  const passes::HoleResources& holes() const { return hole_clusters_.resources(); }
  const passes::SmokeShadows& shadows() const { return shadows_; }
  /// The rays of the march; empty where each pixel has its own.
  const std::optional<passes::MarchTiles>& march_tiles() const { return march_tiles_; }
  /// What SmokeFrameOptions lets the march count: a word, and one per pixel where it records entries.
  const gpu::Buffer& march_counters() const { return counters_; }

 private:
  void record_raycast(gpu::Recorder& recorder, const planning::FramePlan& plan,
                      const FrameResources& in) const;
  /// What marches the frame's rays, and where it counts.
  struct March {
    const passes::MarchPass& pass;
    const gpu::Buffer& counters;
  };
  void make_noise();
  void record_shadows(gpu::Recorder& recorder, const planning::FramePlan& plan, const FrameResources& in);
  /// Calls `record` with what the light in the volumes is found from.
  template <typename Record>
  void with_volume_light_inputs(const planning::FramePlan& plan, const FrameResources& in, Record record);
  passes::SmokeLightPass::Inputs light_inputs(const planning::FramePlan& plan,
                                              const FrameResources& in) const;
  March march_of(const FrameResources& in) const;
  passes::MarchPass::Inputs march_inputs(const planning::FramePlan& plan, const FrameResources& in) const;

  gpu::Context& context_;
  gpu::CommandStream& stream_;
  glm::uvec2 size_px_;
  bool brute_force_holes_, record_entries_;
  bool prepare_all_, has_noise_ = false;
  std::uint32_t march_scale_ = 1;

  // Data on the device.
  passes::SmokeUpload smoke_upload_;
  passes::VolumeUpload volume_upload_;
  passes::HoleClusters hole_clusters_;
  passes::SmokeShadows shadows_;
  gpu::Image noise_, detail_;
  gpu::Buffer counters_;
  std::optional<passes::MarchTiles> march_tiles_;  ///< Where march_scale_ is above 1.

  // Passes.
  passes::NoiseAdvectionPass noise_advection_pass_;
  passes::SmokeShadowPass shadow_pass_;
  passes::SmokeLightPass light_pass_;
  passes::FineLightPass fine_light_pass_;
  passes::GlowFieldPass glow_field_pass_;
  passes::VolumeLightPass volume_light_pass_;
  std::optional<passes::RaycastForm> raycast_;
  std::optional<passes::RaycastPass> raycast_pass_;  ///< In the place of the march.
  passes::MarchPass march_pass_;
  std::optional<passes::MarchPass> counting_march_;        ///< For the view of steps.
  std::optional<passes::ResolvePass> resolve_pass_;        ///< Where there are march_tiles_, or may be.
  std::optional<passes::AccumulatePass> accumulate_pass_;  ///< Where smoke is accumulated over frames.
};

}  // namespace brume::render
