// What the parts of a frame share.
//
// A part is one thing that a frame shows: the level, the smoke, the volumes, the rays through all media,
// slices of volumes, decals, particles, tanks, the surfaces of a host, motion, the picture. It has what
// it needs of these functions, which are called in this order:
//
// - prepare(input) uploads what the plan depends on.
// - reserve(plan) makes room. Nothing is recorded yet; both may throw resource_limit.
// - upload(recorder, plan) copies the plan's data to the device.
// - record...(recorder, plan, resources) records commands.
//
// What a part knows about the contents of the device is a gpu::Recorded, so that a dropped recording leaves
// no trace in it. What a plan decided counts once the renderer commits it (planning::PlanHistory).
#pragma once

#include <optional>

#include "passes/media_resources.hpp"
#include "passes/raycast.hpp"
#include "passes/shade.hpp"
#include "passes/smoke_shadow.hpp"
#include "planning/frame_plan.hpp"
#include "render/targets.hpp"

namespace brume::render {

using planning::FrameInput;
using planning::FramePlan;

/// How the media of all frames are drawn.
struct MediaOptions {
  bool count_samples = false;      ///< Count the texture samples of the march (slower).
  bool brute_force_holes = false;  ///< See MarchPass::Options.
  std::uint32_t march_scale = 1;   ///< Pixels per ray of the march along each axis: 1, 2 or 4.
  /// Prepares at once what any later frame of smoke may need, so that none waits for it: pipelines of all
  /// march scales and qualities, the noise. Otherwise each is prepared for the first frame that needs it.
  bool prepare_all = false;
  /// Draws the volumes alone, one by one, without light from each other; needs march_scale 1.
  std::optional<passes::RaycastForm> raycast = {};
  bool temporal = false;                    ///< Accumulate media over the frames of a film (View::continues).
  const smoke::MaskAtlas* masks = nullptr;  ///< Masks of the holes; null: none. Uploaded by the constructor.
  bool record_entries = false;              ///< See MarchPass::Options: into MarchPart::counters().
  /// The device holds the smoke that is in view, not all of it. The place of a brick in the atlas then
  /// depends on earlier frames, and with it how samples of the brick are rounded.
  bool memory_follows_view = false;
  /// Bricks of smoke for which there always is memory: as many as an atlas of volume::grown_atlas holds.
  std::uint32_t reserved_bricks = 64;
};

/// The resources of parts that other parts read.
struct FrameResources {
  const gpu::Buffer& frame;  ///< FrameConstants.
  const Targets& targets;
  const gpu::Image& surfaces;  ///< Depth where rays end: the G-buffer's, nearer at a tank.
  const gpu::Image& blue_noise;

  const passes::SceneResources& scene;
  const passes::ShadowMaps& shadows;
  passes::LevelLight level;

  passes::MediaResources media;      ///< As rays from the eye meet them.
  passes::MediaResources lit_media;  ///< As rays of light meet them.
  passes::MediaLight media_light;    ///< The light in `media`.
  const gpu::Image &noise, &detail;  ///< Tiles of noise.
  const passes::SmokeShadows& smoke_shadows;
  const gpu::Image& glow_field;  ///< GlowFieldPass::field.

  /// Receives the steps of each pixel's ray (MarchPass::Options::count_steps); null: none are counted.
  const gpu::Buffer* step_counters = nullptr;
};

/// Records the commands of a step, whose GPU time is measured under its name.
template <typename Record>
void scope(gpu::Recorder& recorder, const char* name, Record record) {
  const gpu::Scope timed(recorder, name);
  record();
}

}  // namespace brume::render
