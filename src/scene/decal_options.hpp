// The decals of a timeline.
#pragma once

#include <cstddef>
#include <filesystem>
#include <glm/glm.hpp>
#include <string>

namespace brume::scene {

/// A decal of baked occlusion (brume bake occlusion): darkens the surfaces in its box.
struct DecalOptions {
  std::filesystem::path file;  ///< A volume, resolved.
  /// Holds the occlusion; empty: up and down if there are such grids, else the first.
  std::string grid = {};
  std::string carrier = {};     ///< Empty: the world.
  glm::vec3 position_world{0};  ///< In the carrier's space if there is one.
  glm::vec3 rotation{0};        ///< About x, then y, then z [degrees].
  float scale = 1;
  float strength = 1;
  float gamma = 1;
  float correction = 1;
  float falloff = 1;
  float fade = 0.05f;
  float scatter = 0.5f;
  std::string place = {};  ///< "file:line:column" for error messages.
};
/// Decals of a timeline at most: a frame shows as many.
inline constexpr std::size_t kMostDecals = 32;

}  // namespace brume::scene
