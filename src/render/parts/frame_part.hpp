// What a frame gives to each of its parts.
//
// A part is one thing that a frame shows: the level, the smoke, the volumes, the rays through all media,
// decals, particles, the picture, tanks, the surfaces of a host. Each has the same verbs, in this order:
//
// - reserve(plan) makes room outside of a recording. Where it throws resource_limit, nothing was recorded.
// - upload(recorder, plan) copies what the plan has for the device.
// - record...(recorder, plan, resources) records its commands.
//
// What a part remembers of the device it holds as gpu::Recorded, so that a recording that is dropped never
// was; what a plan decided counts when the renderer commits it (planning::PlanHistory).
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
  /// Prepares at once what any later frame may need, so that none waits for it: pipelines of all march
  /// scales, the noise of smoke. Otherwise each is prepared for the first frame that needs it.
  bool prepare_all = false;
  /// Draws the volumes alone, one by one, without light from each other; needs march_scale 1.
  std::optional<passes::RaycastForm> raycast = {};
  bool temporal = false;                    ///< Accumulate media over the frames of a film (View::continues).
  const smoke::MaskAtlas* masks = nullptr;  ///< Masks of the holes; null: none. Uploaded by the constructor.
  bool record_entries = false;              ///< See MarchPass::Options: into MarchPart::counters().
  /// The device holds the smoke that is in view, not all of it. Pictures then depend on the frames before by
  /// the rounding of places in the atlas.
  bool memory_follows_view = false;
  /// Bricks of smoke that always have memory: as many as some volume::grown_atlas holds.
  std::uint32_t reserved_bricks = 64;
};

/// The resources of all parts that others read.
struct FrameResources {
  const gpu::Buffer& frame;  ///< FrameConstants.
  const Targets& targets;
  const gpu::Image& surfaces;  ///< Depth of what is opaque to media: the G-buffer's, nearer where a tank is.
  const gpu::Image& blue_noise;

  const passes::SceneResources& scene;
  const passes::ShadowMaps& shadows;
  passes::LevelLight level;

  passes::MediaResources media;      ///< As rays of the eye meet them.
  passes::MediaResources lit_media;  ///< As light does.
  passes::MediaLight media_light;    ///< In the media of the eye.
  const gpu::Image &noise, &detail;  ///< Tiles of noise.
  const passes::SmokeShadows& smoke_shadows;
  const gpu::Image& glow_field;  ///< GlowFieldPass::field.

  /// Where the march counts the steps of each pixel (MarchPass::Options::count_steps); null: nowhere.
  const gpu::Buffer* step_counters = nullptr;
};

/// Records the commands of a step, measured under its name.
template <typename Record>
void scope(gpu::Recorder& recorder, const char* name, Record record) {
  const gpu::Scope timed(recorder, name);
  record();
}

}  // namespace brume::render
