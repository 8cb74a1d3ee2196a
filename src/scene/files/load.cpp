#include "scene/files/load.hpp"

#include <algorithm>

#include "core/file.hpp"
#include "core/progress.hpp"
#include "scene/files/gltf.hpp"
#include "scene/files/obj.hpp"
#include "scene/files/scene_files.hpp"
#include "scene/files/scene_txt.hpp"

namespace brume::scene {

std::string lower_extension(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return extension;
}

namespace {

Result<Scene> parse_file(const std::filesystem::path& path, const FolderFiles& files, ImageUse use) {
  const std::string extension = lower_extension(path);
  if (extension == ".txt" || extension == ".obj") {
    const auto text = read_text_file(path);
    if (!text) return text.failure();
    return extension == ".txt" ? parse_scene_txt(*text, path.string(), files, use)
                               : parse_obj_scene(*text, path.string(), files, use);
  }
  if (extension == ".gltf" || extension == ".glb") {
    const auto bytes = read_file(path);
    if (!bytes) return bytes.failure();
    return parse_gltf(*bytes, path.string(), files, use);
  }
  return Failure{
      ErrorCode::bad_input,
      path.string() +
          ": not a scene file by its name; expected .txt, .gltf, .glb or .obj, or .toml for a timeline"};
}

bool has_triangle(const Scene& scene) {
  return std::ranges::any_of(
      scene.objects, [&](const Object& object) { return !scene.meshes[object.mesh].indices.empty(); });
}

}  // namespace

Result<Scene> load_scene(const std::filesystem::path& path, bool may_be_empty, ImageUse use) {
  const Progress job("load");
  const FolderFiles files(path.parent_path());
  auto scene = parse_file(path, files, use);
  if (!scene) return scene;
  if (!may_be_empty && !has_triangle(*scene))
    return Failure{ErrorCode::bad_input,
                   path.string() + ": the scene has no triangle; add at least one object with a mesh"};
  scene->files = {path};
  scene->files.insert(scene->files.end(), files.files_read().begin(), files.files_read().end());
  return scene;
}

}  // namespace brume::scene
