// The media of a frame: which are visible, which cast shadows into view, and what rays need to know of all of
// them together.
#pragma once

#include <array>
#include <span>

#include "planning/frame_input.hpp"
#include "planning/input_key.hpp"
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
  bool is_preview = false;            ///< Density and heat are previews, where they have one.
  ShownGrids grids{};
  VolumeTables tables{};
};

struct MediaPlan {
  std::uint32_t media = 0;    ///< Set of shared::kMedium..., of what may be in view, and kRaysParallel.
  std::uint32_t casters = 0;  ///< The same of all that may cast shadows, in view or not.
  /// Those that may be in view, FrameMedia::volume_count, before those that only cast shadows.
  FrameVector<PlacedVolume> volumes;
  shared::VolumeLayout smoke{};  ///< The smoke in view; without smoke empty, with voxels of 1 m.
  shared::FrameMedia frame{};
  Box<float> caster_bounds = kEmptyBox;  ///< Around all that light may meet, in the world; empty: nothing.
  std::uint32_t caster_count = 0;        ///< Media that light may meet: the smoke, and each volume.
  float mean_cosine = 0;                 ///< Mean cosine of scattering in the first of them.
  bool needs_noise = false;              ///< A medium is drawn with tiles of noise.
  std::uint32_t sun = shared::kNoSun;    ///< In the frame's lights: that of FrameMedia::to_sun.
};

/// The media of a frame of smoke alone.
shared::FrameMedia smoke_media(const shared::VolumeLayout& smoke, const shared::SmokeLook& look);

/// The tints, the disturbance and the place of the detail of a volume.
shared::VolumeEffect volume_effect(const VolumeInput& volume);

/// The detail of a volume; its strength is 0 without any.
shared::VolumeDetail volume_detail(const VolumeInput& volume);

/// A volume as it is, or its previews in their places.
VolumeInput shown_volume(const VolumeInput& volume, bool preview);

/// Gives the volumes of a plan their tables; `tables`: of each volume of the input.
void set_tables(MediaPlan& plan, std::span<const VolumeTables> tables);

/// Boxes in the world around all that may cast shadows. `visibility` and `smoke`: as for plan_media.
FrameVector<Box<float>> caster_boxes(const MediaPlan& plan, const SmokeVisibility& visibility,
                                     const smoke::SmokeBricks* smoke, Allocator memory = {});

/// Adds what light follows from of all that it may meet but the smoke, whose caches have keys of their own.
void add_casters(InputKey& key, const MediaPlan& media, std::span<const VolumeInput> volumes);

/// The sets of media that frames of all qualities and looks march through instead of this one.
std::array<std::uint32_t, 4> media_of_all_qualities(std::uint32_t media);

/// The volumes of a plan that may be in view.
std::span<const PlacedVolume> volumes_in_view(const MediaPlan& plan);

/// The same volumes at other resolutions: `previews` as for plan_media.
void choose_previews(MediaPlan& plan, std::span<const VolumeInput> volumes, std::span<const bool> previews);

/// `previews`: of each volume of the input, whether its preview is shown; empty: none. `smoke`: that of the
/// visibility; null: none. All boxes of the media, those of the frame included, are in the world [m].
/// Throws bad_input for a transform without an inverse and for more than shared::kMaxVolumes volumes.
MediaPlan plan_media(const FrameInput& input, const SmokeVisibility& visibility, const ViewFrustum& frustum,
                     std::span<const shared::Light> lights, std::span<const bool> previews = {},
                     const smoke::SmokeBricks* smoke = nullptr, Allocator memory = {});

}  // namespace brume::planning
