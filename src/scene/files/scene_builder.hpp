// Shared by all loaders: deduplicated meshes and images, stand-ins, mirrored copies, final checks.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "scene/files/scene_files.hpp"
#include "scene/scene.hpp"

namespace brume::scene {

/// Maximum distance of any point from the origin, along each axis [m].
constexpr float kFarthest = 1e7f;
/// Maximum number of vertices and indices of a scene, before instancing, and of bytes of its decoded images.
constexpr std::uint64_t kMostVertices = 1ull << 26, kMostIndices = 1ull << 28, kMostImageBytes = 1ull << 32;

constexpr const char* kCheckerStandsIn = "a magenta checker stands in";

class SceneBuilder {
 public:
  /// `name` names the scene in messages. The files must outlive the builder.
  SceneBuilder(const SceneFiles& files, std::string name, ImageUse use = ImageUse::pictures)
      : files_(files), name_(std::move(name)), use_(use) {}

  Scene scene;

  /// resource_limit when the scene would pass kMostVertices or kMostIndices.
  Result<std::uint32_t> add_mesh(Mesh mesh);
  /// The first existing file of `names`, decoded; each file is read once for each way in which it wraps. If
  /// it is missing or damaged, logs a warning that starts with `place`, ends with `instead`, and returns the
  /// magenta checker. `use` says what this image is for: `roles` if it decides one.
  std::uint32_t image_of_file(std::span<const std::string> names, const std::string& place,
                              const char* instead = kCheckerStandsIn, ImageUse use = ImageUse::pictures,
                              Wraps wraps = {});
  /// The same from named bytes in memory.
  std::uint32_t image_of_bytes(std::span<const std::byte> bytes, const std::string& name,
                               const std::string& place, ImageUse use = ImageUse::pictures, Wraps wraps = {});
  /// An image with the values of the first existing file of `names` as its alpha: that file's own alpha if it
  /// has any, else its brightness. kNone as `color` counts as white. It is as large as the larger of both.
  /// kNone, with a warning that starts with `place`, if the file is missing or damaged.
  std::uint32_t image_with_opacity(std::uint32_t color, std::span<const std::string> names,
                                   const std::string& place, Wraps wraps = {});
  std::uint32_t checker_image();
  /// Logs the line, unless images are loaded for less than `use`.
  void warn_of_image(ImageUse use, const std::string& line) const;
  bool is_checker(std::uint32_t image) const { return image == checker_ && image != kNone; }
  /// The index of the stand-in cube.
  Result<std::uint32_t> cube_mesh();

  /// Adds an object; if its matrix mirrors, with a mirrored copy of its mesh. An object flattened by a zero
  /// scale is skipped, with a warning that starts with `place`.
  Result<void> add_object(Object object, const std::string& place);
  /// Makes the object the scene's grenade: a centred copy of its mesh, without the object's position.
  Result<void> set_grenade(const Object& object, const std::string& place);
  bool has_grenade() const { return scene.grenade.has_value(); }

  /// Checks the scene: no point beyond kFarthest.
  Result<Scene> finish() &&;

 private:
  Result<std::uint32_t> mirrored_mesh(std::uint32_t mesh);
  std::uint32_t add_image(Result<image::Image8> pixels, const std::string& name, const std::string& place,
                          ImageUse use, Wraps wraps);
  Result<void> check_object(const Object& object) const;

  const SceneFiles& files_;
  std::string name_;
  ImageUse use_ = ImageUse::pictures;
  std::map<std::pair<std::string, Wraps>, std::uint32_t> images_;
  std::map<std::pair<std::uint32_t, std::string>, std::uint32_t> with_opacity_;
  std::set<std::string> missing_opacities_;
  std::map<std::uint32_t, std::uint32_t> mirrored_;
  std::uint32_t checker_ = kNone, cube_ = kNone;
  std::uint64_t vertices_ = 0, indices_ = 0, image_bytes_ = 0;
};

}  // namespace brume::scene
