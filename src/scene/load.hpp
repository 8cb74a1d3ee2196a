// Scene files in: Scene.txt, glTF 2.0 / GLB, OBJ.
#pragma once

#include <filesystem>

#include "core/error.hpp"
#include "scene/scene.hpp"

namespace brume::scene {

/// Loads a scene by its file name: `.txt` (Scene.txt), `.gltf`, `.glb` or `.obj`. What can be mended (a
/// missing mesh or texture) is a warning that names file and line, and a visible stand-in; what cannot is
/// bad_input with file:line:column and what was expected. Every mesh index in the result is valid, every
/// number finite.
Result<Scene> load_scene(const std::filesystem::path& path);

}  // namespace brume::scene
