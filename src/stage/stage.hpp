// A stage: what a timeline needs before anything happens, on a machine without a graphics card too.
#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "scene/timeline.hpp"
#include "sim/mask_atlas.hpp"
#include "stage/shot_masks.hpp"
#include "stage/vxl_file.hpp"

namespace brume::stage {

struct Stage {
  scene::Timeline timeline;
  scene::Scene scene;
  scene::Camera camera;  ///< Where the timeline has no camera keys.
  Voxels voxels;
  sim::MaskAtlas masks = {};  ///< Of the holes of its shots.
  ShotMasks shot_masks = {};  ///< Which of them is whose.
};

/// Loads a timeline (.toml), or a scene file with the timeline that fits it. Voxels are kept beside the
/// scene's name in `cache_folder` (empty: not kept).
Result<Stage> load_stage(const std::filesystem::path& input, const std::filesystem::path& cache_folder);

/// The same for a timeline that is already there; its scene is loaded from Timeline::scene.
Result<Stage> make_stage(scene::Timeline timeline, const std::filesystem::path& cache_folder);

}  // namespace brume::stage
