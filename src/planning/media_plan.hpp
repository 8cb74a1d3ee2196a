// The media of a frame: which volumes are visible, which cast shadows into view, and what the march needs to
// know of volumes and smoke together.
#pragma once

#include <span>

#include "planning/frame_input.hpp"
#include "planning/smoke_visibility.hpp"
#include "planning/view_frustum.hpp"
#include "planning/volume_tables.hpp"
#include "shared/light.h"
#include "shared/media.h"
#include "shared/volume_light.h"

namespace brume::planning {

/// The grids of a volume as it is shown, at the resolution of the plan; null: none.
struct ShownGrids {
  const volume::SparseVolume *volume = nullptr, *heat = nullptr, *colors = nullptr;
};

/// A volume of a frame, where it is.
struct PlacedVolume {
  std::size_t index = 0;  ///< In FrameInput::volumes.
  Box<float> bounds_world;
  shared::VolumeInstance instance{};  ///< All but the places of its bricks, which the atlas knows.
  shared::VolumeEffect effect{};      ///< Tints and disturbance.
  bool is_preview = false;            ///< Of the previews of density and heat, where they have one.
  ShownGrids grids{};
  VolumeTables tables{};
};

struct MediaPlan {
  std::uint32_t media = 0;    ///< Set of shared::kMedium..., of what may be in view.
  std::uint32_t casters = 0;  ///< The same of all that may cast shadows, in view or not.
  /// Those that may be in view, FrameMedia::volume_count, before those that only cast shadows.
  FrameVector<PlacedVolume> volumes;
  shared::VolumeLayout smoke{};  ///< Of the smoke in view; without smoke a unit grid.
  shared::FrameMedia frame{};
  std::uint32_t sun = shared::kNoSun;  ///< In the frame's lights: that of FrameMedia::to_sun.
};

/// Of the smoke alone.
shared::FrameMedia smoke_media(const shared::VolumeLayout& smoke, const shared::SmokeLook& look);

/// The tints, the disturbance and the place of the detail of a volume.
shared::VolumeEffect volume_effect(const VolumeInput& volume);

/// The detail of a volume; its strength is 0 without any.
shared::VolumeDetail volume_detail(const VolumeInput& volume);

/// A volume as it is, or its previews in their places.
VolumeInput shown_volume(const VolumeInput& volume, bool preview);

/// Gives the volumes of a plan their tables; `tables`: of each volume of the input.
void set_tables(MediaPlan& plan, std::span<const VolumeTables> tables);

/// The volumes of a plan that may be in view.
std::span<const PlacedVolume> volumes_in_view(const MediaPlan& plan);

/// The same volumes at other resolutions: `previews` as for plan_media.
void choose_previews(MediaPlan& plan, std::span<const VolumeInput> volumes, std::span<const bool> previews);

/// `previews`: of each volume of the input, whether its preview is shown; empty: none. `smoke`: that of the
/// visibility; null: none.
/// Throws bad_input for a transform without an inverse and for more than shared::kMaxVolumes volumes.
MediaPlan plan_media(const FrameInput& input, const SmokeVisibility& visibility, const ViewFrustum& frustum,
                     std::span<const shared::Light> lights, std::span<const bool> previews = {},
                     const smoke::SmokeBricks* smoke = nullptr, Allocator memory = {});

}  // namespace brume::planning
