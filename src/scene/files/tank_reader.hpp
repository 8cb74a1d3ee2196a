// Reads the scene of a tank alone: a file of its own, with [tank].
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "scene/tank_scene.hpp"

namespace brume::scene {

/// What a file of a tank alone is shown with: a light above it, and a bright sky.
TankScene scene_of_tank_file(const std::filesystem::path& tank);

/// Whether a file is one of a tank: a .toml file with a table [tank]. False where it cannot be read.
bool is_tank_scene(const std::filesystem::path& path);
/// The files that its text names, whether or not they exist or the scene is valid; none where it cannot be
/// read.
std::vector<std::filesystem::path> files_named_by_tank_scene(const std::filesystem::path& path);
/// Reads it. Fails as load_timeline.
Result<TankScene> load_tank_scene(const std::filesystem::path& path);
Result<TankScene> parse_tank_scene(std::string_view text, const std::filesystem::path& path);

}  // namespace brume::scene
