// All that a frame needs to know before it is recorded: what is visible, what changed, what is updated. Found
// once a frame; passes make room by it and record it.
#pragma once

#include <memory>
#include <vector>

#include "planning/decal_plan.hpp"
#include "planning/fine_light_plan.hpp"
#include "planning/frame_input.hpp"
#include "planning/hole_plan.hpp"
#include "planning/indirect_light_plan.hpp"
#include "planning/media_plan.hpp"
#include "planning/noise_updates.hpp"
#include "planning/opaque_limit.hpp"
#include "planning/resident_smoke.hpp"
#include "planning/smoke_light_cache.hpp"
#include "planning/smoke_shadow_cache.hpp"
#include "planning/view_frustum.hpp"
#include "planning/volume_light_plan.hpp"
#include "planning/volume_streaming.hpp"

namespace brume::planning {

/// What plans follow from besides the frame's input: the scene, and what the renderer draws into.
struct PlanTarget {
  std::span<const shared::Light> lights;  ///< Of the scene.
  Box<float> scene_bounds;                ///< Around all surfaces.
  std::span<const Emitter> emitters;      ///< Surfaces that emit.
  glm::mat4 sun_clip_from_world{1};
  glm::uvec2 size_px{1};
  glm::uvec2 smoke_shadow_atlas{0};              ///< Size of the atlas in texels.
  std::span<const shared::SliceTexture> slices;  ///< What particles may display.
  /// The atlas of the smoke, and how much of it the device may hold (ResidentSmoke::Request).
  glm::ivec3 atlas_bricks{0};
  std::uint32_t most_bricks = ResidentSmoke::kUnlimited;
  /// The device holds all smoke, in the slots of the volume: the picture is the same to the bit whatever
  /// frames there were before.
  bool holds_all_smoke = false;
};

struct FramePlan {
  /// The plan of a frame in which nothing is visible; its lists are in `memory`, as those of copies are not.
  FramePlan(const FrameInput& frame_input, glm::uvec2 frame_size_px, Allocator memory = {});

  const FrameInput& input;   ///< Outlives the plan.
  std::uint64_t number = 0;  ///< Of a renderer's plans, by which it knows the one that is valid.
  glm::uvec2 size_px{1};

  // What is visible.
  shared::Camera camera;
  ViewFrustum frustum;
  FrameVector<shared::Light> lights;  ///< Of the scene and of the frame that reach what is in view.
  /// That the device holds, in the history; null: none. Slots and voxels of the plan are of this.
  const smoke::SmokeBricks* smoke = nullptr;
  SmokeVisibility visibility;
  MediaPlan media;
  FrameVector<PlacedDecal> decals;
  /// The media as light is found in them and shadows are cast by them: volumes may have other resolutions.
  MediaPlan lit_media;
  std::vector<shared::ParticleSystem> particles;  ///< In view.

  // What changed.
  bool level_changed = false;                  ///< Walls or hidden objects.
  FrameVector<std::uint32_t> changed_objects;  ///< Hidden or shown since the frame before, rising.

  // What is updated.
  std::vector<VolumeResidency> residency;  ///< Of the input's volumes.
  HolePlan holes;
  NoisePlan noise;
  std::optional<SmokeShadowUpdate> smoke_shadows;  ///< Empty: those of the frame before hold.
  FineLightPlan fine_light;
  const SmokeLightPlan* smoke_light = nullptr;  ///< In the history, until it plans again; not null in a plan.

  VolumeLightPlan volume_light;
  IndirectLightPlan indirect_light;

  ViewSlice view_slice;  ///< Where debug views cut.

  /// The state whose clouds and events the frame shows; an empty one where the input has none.
  const sim::State& state() const;
};

/// What the caches of a renderer hold, and the level of the frame before.
struct PlanHistory {
  std::unique_ptr<FrameMemory> memory = std::make_unique<FrameMemory>();  ///< Of the plan.
  NoiseUpdates noise;
  SmokeShadowCache smoke_shadows;
  SmokeLightCache smoke_light;
  VolumeLightCache volume_light;
  IndirectLightCache indirect_light;
  std::unique_ptr<ResidentSmoke> resident = std::make_unique<ResidentSmoke>();
  VolumeStreaming volume_streaming;
  LevelView level;
  std::vector<std::uint32_t> hidden_objects;
};

/// Plans a frame, which must then be recorded: its updates count as done. The plan is valid until the next
/// one of this history, and no longer than `input`.
FramePlan plan_frame(const FrameInput& input, const PlanTarget& target, PlanHistory& history);

/// Plans the light in the smoke again after the device lost what was cached of it.
void replan_smoke_light(FramePlan& plan, PlanHistory& history);

}  // namespace brume::planning
