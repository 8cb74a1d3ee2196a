// What all loaders share: meshes and images once each, stand-ins, mirrored copies, the last checks.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "scene/files.hpp"
#include "scene/scene.hpp"

namespace brume::scene {

/// No point of a scene may be farther from the origin [m].
constexpr float kFarthest = 1e7f;
/// Most vertices and indices of a scene, before instancing; most bytes of its decoded images.
constexpr std::uint64_t kMostVertices = 1ull << 26, kMostIndices = 1ull << 28, kMostImageBytes = 1ull << 32;

class SceneBuilder {
 public:
  /// `name` is what messages call the scene. The files must outlive the builder.
  SceneBuilder(const SceneFiles& files, std::string name) : files_(files), name_(std::move(name)) {}

  Scene scene;

  /// resource_limit when the scene would pass kMostVertices or kMostIndices.
  Result<std::uint32_t> add_mesh(Mesh mesh);
  /// The first of the files that exists, decoded; each file is read once. A missing or damaged one is a
  /// warning that begins with `place`, and the magenta checker.
  std::uint32_t image_of_file(std::span<const std::string> names, const std::string& place);
  /// The same from bytes in memory under a name of their own.
  std::uint32_t image_of_bytes(std::span<const std::byte> bytes, const std::string& name,
                               const std::string& place);
  std::uint32_t checker_image();
  /// The index of the stand-in cube.
  Result<std::uint32_t> cube_mesh();

  /// Adds an object whose matrix may mirror (it then gets a mirrored copy of its mesh). An object flattened
  /// to nothing by a zero scale is a warning that begins with `place`, and is left out.
  Result<void> add_object(Object object, const std::string& place);
  /// Makes the object the scene's grenade: a centred copy of its mesh, without the object's position.
  Result<void> set_grenade(const Object& object, const std::string& place);
  bool has_grenade() const { return scene.grenade.has_value(); }

  /// Checks the scene: at least one triangle, no point
  /// beyond kFarthest.
  Result<Scene> finish() &&;

 private:
  Result<std::uint32_t> mirrored_mesh(std::uint32_t mesh);
  std::uint32_t add_image(Result<image::Image8> pixels, const std::string& name, const std::string& place);
  Result<void> check_object(const Object& object) const;

  const SceneFiles& files_;
  std::string name_;
  std::map<std::string, std::uint32_t> images_;
  std::map<std::uint32_t, std::uint32_t> mirrored_;
  std::uint32_t checker_ = kNone, cube_ = kNone;
  std::uint64_t vertices_ = 0, indices_ = 0, image_bytes_ = 0;
};

}  // namespace brume::scene
