// Loads scene files: Scene.txt, glTF 2.0 / GLB, OBJ.
#pragma once

#include <filesystem>
#include <string>

#include "core/error.hpp"
#include "scene/files/scene_files.hpp"
#include "scene/scene.hpp"

namespace brume::scene {

/// The file extension in lower case (of ASCII), with its dot: ".toml" for "D.TOML".
std::string lower_extension(const std::filesystem::path& path);

/// Loads a scene by its file extension, in any case: `.txt` (Scene.txt), `.gltf`, `.glb` or `.obj`.
/// Recoverable problems (a missing mesh or texture) give a warning with file and line, and a visible
/// stand-in; all others fail with bad_input, file:line:column and the expectation. Every mesh index in the
/// result is valid, every number finite. Only images of this use are missed. Without a triangle it fails
/// unless `may_be_empty`: a file of lights and a camera.
Result<Scene> load_scene(const std::filesystem::path& path, bool may_be_empty = false,
                         ImageUse use = ImageUse::pictures);

}  // namespace brume::scene
