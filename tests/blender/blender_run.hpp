// One run of Blender with the add-on, for all tests of this folder.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace brume::blender {

/// The output of make_level.py: folders `courtyard`, `small` and `box`, each with txt/level.txt,
/// gltf/level.glb and their timelines, and JSON files with facts from Blender.
struct BlenderRun {
  bool blender_is_there = false;
  int exit_code = -1;
  std::string log;
  std::filesystem::path folder;
};

/// Runs Blender at the first call; the folder exists until the program ends.
const BlenderRun& blender_run();

nlohmann::json read_json(const std::filesystem::path& path);

}  // namespace brume::blender
