// A scenario: a timeline with its scene, voxels and masks loaded. Requires no GPU.
#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "scenario/first_view.hpp"
#include "scenario/lens_openings.hpp"
#include "scenario/shot_masks.hpp"
#include "scenario/slice_volumes.hpp"
#include "scenario/tank.hpp"
#include "scenario/voxel_cache.hpp"
#include "scene/timeline.hpp"
#include "smoke/mask_atlas.hpp"
#include "volumes/volumes.hpp"

namespace brume::scenario {

struct Scenario {
  scene::Timeline timeline;
  scene::Scene scene;
  scene::Camera camera;  ///< Used when the timeline has no camera keys.
  Voxels voxels;
  smoke::MaskAtlas masks = {};  ///< The masks of its shots and texts.
  ShotMasks shot_masks = {};    ///< Which mask each shot and text uses.
  /// Whether the exposure that fits its first image replaces Timeline::exposure (film::measure_exposure).
  bool measure_exposure = false;
  std::shared_ptr<brume::volumes::Volumes> volumes = {};  ///< Timeline::volumes, loaded; null: none.
  SliceVolumes slices = {};                               ///< Volumes of Timeline::decals.
  std::vector<LitTank> tanks = {};                        ///< Tanks of Timeline::tanks.
  LensOpenings lens_openings = {};                        ///< Images of openings in the camera's keys.
  /// Whether `camera` frames the scene, whose file has none.
  bool camera_is_fitted = false;
};

/// Whether a file is a timeline, by its suffix .toml in any case.
bool is_timeline(const std::filesystem::path& path);

/// Loads a timeline (.toml), a scene file as prepare_first_view completes it, or a file of grids as
/// prepare_volume_view does. Voxels are cached in
/// `cache_folder` under the scene's name (empty: not cached).
Result<Scenario> load_scenario(const std::filesystem::path& input, const std::filesystem::path& cache_folder,
                               const FirstViewOptions& options = {});

/// The same for a timeline in memory; loads its scene from Timeline::scene.
Result<Scenario> make_scenario(scene::Timeline timeline, const std::filesystem::path& cache_folder);

/// Where the voxels of a timeline's scene are: as the timeline says, or around the scene's bounds with room
/// for a whole smoke; without the volumes where these are too large. Fails as voxel::layout_around.
Result<voxel::GridLayout> grid_layout(const scene::Timeline& timeline, const scene::Scene& scene);

/// Every file that it was made from: scene, textures and buffers, masks of shots, fonts of texts. Without the
/// timeline's own.
std::vector<std::filesystem::path> files_of(const Scenario& scenario);

}  // namespace brume::scenario
