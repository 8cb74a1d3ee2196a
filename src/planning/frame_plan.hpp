// All that a frame needs to know before it is recorded: what is visible, what changed, what is updated. Found
// once a frame; passes make room by it and record it.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "planning/decal_plan.hpp"
#include "planning/device_camera.hpp"
#include "planning/fine_light_plan.hpp"
#include "planning/frame_input.hpp"
#include "planning/hole_plan.hpp"
#include "planning/indirect_light_plan.hpp"
#include "planning/media_plan.hpp"
#include "planning/noise_updates.hpp"
#include "planning/opaque_limit.hpp"
#include "planning/proposed.hpp"
#include "planning/resident_smoke.hpp"
#include "planning/smoke_light_cache.hpp"
#include "planning/smoke_shadow_cache.hpp"
#include "planning/view_frustum.hpp"
#include "planning/volume_light_plan.hpp"
#include "planning/volume_streaming.hpp"

namespace brume::planning {

/// What the device has room for at present. Where a plan needs more, what was cached there is lost.
struct PlanRoom {
  /// The atlas of the smoke, and how much of it the device may hold (ResidentSmoke::Request).
  glm::ivec3 atlas_bricks{0};
  std::uint32_t most_bricks = ResidentSmoke::kUnlimited;
  SmokeLightRoom smoke_light{};
  VolumeLightRoom volume_light{};
  bool holds_indirect_light = true;  ///< The light of the last committed frame.
};

/// What plans follow from besides the frame's input: the scene, and what the renderer draws into.
struct PlanTarget {
  std::span<const shared::Light> lights;  ///< The scene's; a frame adds its own.
  Box<float> scene_bounds;                ///< Around all surfaces.
  std::span<const Emitter> emitters;      ///< Surfaces that emit.
  glm::mat4 sun_clip_from_world{1};
  glm::uvec2 size_px{1};
  glm::uvec2 smoke_shadow_atlas{0};              ///< Size of the atlas in texels.
  std::span<const shared::SliceTexture> slices;  ///< What particles may display.
  PlanRoom room{};
  /// The device holds all smoke, in the slots of the volume: the picture is the same to the bit whatever
  /// frames there were before.
  bool holds_all_smoke = false;
};

struct FramePlan {
  /// The plan of a frame in which nothing is visible; its lists are in `memory`. The lists of copies are not.
  FramePlan(const FrameInput& frame_input, glm::uvec2 frame_size_px, Allocator memory = {});

  const FrameInput& input;   ///< Outlives the plan.
  std::uint64_t number = 0;  ///< PlanHistory::plans, by which a renderer knows the plan that is valid.
  glm::uvec2 size_px{1};

  /// The picture before this frame; empty: none is known.
  std::optional<PastView> past;
  /// The same, where smoke and decals accumulate from the frame before on.
  std::optional<PastView> history() const { return input.view.continues ? past : std::nullopt; }

  // What is visible.
  shared::Camera camera;
  ViewFrustum frustum;
  FrameVector<shared::Light> lights;  ///< The scene's and the frame's that reach what is in view.
  /// The smoke that the device holds, in the history; null: none. Slots and voxels of the plan are in it.
  const smoke::SmokeBricks* smoke = nullptr;
  SmokeVisibility visibility;
  MediaPlan media;
  FrameVector<PlacedDecal> decals;
  /// The media as light is found in them and shadows are cast by them: volumes may have other resolutions.
  MediaPlan lit_media;
  std::vector<shared::ParticleSystem> particles;  ///< In view.

  // What changed.
  bool level_changed = false;  ///< Walls or hidden objects.

  // What is updated.
  std::vector<VolumeResidency> residency;  ///< By volume of the input.
  HolePlan holes;
  NoisePlan noise;
  std::optional<SmokeShadowUpdate> smoke_shadows;  ///< Empty: the shadows of the frame before hold.
  FineLightPlan fine_light;
  const SmokeLightPlan* smoke_light = nullptr;  ///< In the history, until it plans again; not null in a plan.

  VolumeLightPlan volume_light;
  IndirectLightPlan indirect_light;

  ViewSlice view_slice;  ///< Where debug views cut.

  /// The state whose clouds and events the frame shows; an empty one where the input has none.
  const sim::State& state() const;
};

/// What frames remember: what the device holds of those that were recorded, and their level.
struct PlanHistory {
  std::unique_ptr<FrameMemory> memory = std::make_unique<FrameMemory>();  ///< For the plan.
  NoiseUpdates noise;
  Proposed<InputKey> noise_motion;
  SmokeShadowCache smoke_shadows;
  SmokeLightCache smoke_light;
  VolumeLightCache volume_light;
  IndirectLightCache indirect_light;
  /// Not history but a mirror of smoke::SmokeVolume, whose revisions say what a reader missed.
  std::unique_ptr<ResidentSmoke> resident = std::make_unique<ResidentSmoke>();
  VolumeStreaming volume_streaming;
  VolumeTableCache volume_tables;
  struct Level {
    LevelView voxels;
    std::vector<std::uint32_t> hidden_objects;
  };
  Proposed<Level> level;
  /// The last frame of each view.
  Proposed<std::array<std::optional<PastView>, kMaxViews>> views;
  std::uint64_t plans = 0;

  /// The frame of the last plan was recorded: later ones rely on what it did.
  void commit();
  /// The device lost all that is cached, or the smoke is another volume's.
  void invalidate();
  /// The device lost all light that is cached.
  void invalidate_light();
};

/// Plans a frame. History moves when the frame is committed; a frame that is not leaves it as it was, and may
/// be planned again, for instance with less room. The plan is valid until the next one of this history, and
/// no longer than `input`.
FramePlan plan_frame(const FrameInput& input, const PlanTarget& target, PlanHistory& history);

}  // namespace brume::planning
