// The tanks of a timeline.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <glm/glm.hpp>
#include <optional>
#include <string>

namespace brume::scene {

enum class TankView : std::uint32_t;  // scene/tank_scene.hpp

/// A tank of spheres that stands in the level, with the lights, glass and fog of its own file as they are at
/// the start.
struct TankOptions {
  std::filesystem::path file;   ///< The scene of a tank, or a tank alone (.spheres); resolved.
  std::string carrier = {};     ///< Empty: the world.
  glm::vec3 position_world{0};  ///< Where its middle is; in the carrier's space if there is one.
  glm::vec3 rotation{0};        ///< About x, then y, then z [degrees].
  float scale = 1;
  std::optional<TankView> view = {};  ///< Empty: that of its file.
  std::uint32_t samples = 64;
  std::string place = {};  ///< "file:line:column" for error messages.
};
/// Tanks of a timeline at most: a frame shows as many.
inline constexpr std::size_t kMostTanks = 4;

}  // namespace brume::scene
