// Marks in the picture of a tank that its lights and its glass are dragged by.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "apps/viewer/tank_camera.hpp"
#include "scene/tank_scene.hpp"

namespace brume::viewer {

struct TankHandle {
  enum class Kind { light, glass };
  Kind kind = Kind::light;
  std::size_t index = 0;  ///< Number of the light in the scene; 0 for the glass.
  bool operator==(const TankHandle&) const = default;
};

/// The lights, then the glass if there is one.
std::vector<TankHandle> handles_of(const scene::TankScene& scene);
/// Where it is at a time [s].
glm::vec3 place_of(const scene::TankScene& scene, const TankHandle& handle, double time);
/// Where the mark of a point is in a picture of this size: at its edge for a point that is beside it, nowhere
/// for one behind the camera.
struct TankMark {
  glm::vec2 at{0};
  bool is_at_edge = false;
};
std::optional<TankMark> mark_in(const scene::Camera& camera, glm::vec2 size, const glm::vec3& world);
/// The handle whose mark is nearest to a point of a picture of this size, and at most `reach` from it.
std::optional<TankHandle> handle_at(const scene::TankScene& scene, double time, const scene::Camera& camera,
                                    glm::vec2 size, glm::vec2 point, float reach);
/// Moves what it stands for to a place at a time; one with keys moves with all of them.
void move_handle(scene::TankScene& scene, const TankHandle& handle, double time, const glm::vec3& to);

}  // namespace brume::viewer
