// Writes scenes of tanks as files for load_tank_scene.
#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "scene/tank_scene.hpp"

namespace brume::scene {

/// The text of a scene's file in `folder`. Omits settings with default values. parse_tank_scene restores the
/// same scene, every number bit for bit, but for what packs a tank that has a file, and `place` of cameras.
/// Keys must be sorted as TankScene requires. The tank and openings must lie below the folder to be read
/// again.
std::string format_tank_scene(const TankScene& scene, const std::filesystem::path& folder);

/// Writes the file, completely or not at all, into an existing folder. Copies a tank and openings from
/// outside of that folder into NAME_files beside the file and refers to the copies; never overwrites existing
/// files. Fails with bad_input when one of them cannot be read, or for a scene that could not be read back (a
/// number out of range), and as write_file_atomic does.
Result<void> save_tank_scene(const std::filesystem::path& path, const TankScene& scene);

}  // namespace brume::scene
