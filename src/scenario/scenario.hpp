// A scenario: what a timeline needs before anything happens, on a machine without a graphics card too.
#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "scene/timeline.hpp"
#include "smoke/mask_atlas.hpp"
#include "scenario/shot_masks.hpp"
#include "scenario/vxl_file.hpp"

namespace brume::scenario {

struct Scenario {
  scene::Timeline timeline;
  scene::Scene scene;
  scene::Camera camera;  ///< Where the timeline has no camera keys.
  Voxels voxels;
  smoke::MaskAtlas masks = {};  ///< Of the holes of its shots.
  ShotMasks shot_masks = {};  ///< Which of them is whose.
};

/// Loads a timeline (.toml), or a scene file with the timeline that fits it. Voxels are kept beside the
/// scene's name in `cache_folder` (empty: not kept).
Result<Scenario> load_scenario(const std::filesystem::path& input, const std::filesystem::path& cache_folder);

/// The same for a timeline that is already there; its scene is loaded from Timeline::scene.
Result<Scenario> make_scenario(scene::Timeline timeline, const std::filesystem::path& cache_folder);

}  // namespace brume::scenario
