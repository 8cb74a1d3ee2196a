// Objects of the scene that move with carriers.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "scene/carrier.hpp"
#include "scene/scene.hpp"

namespace brume::scene {

struct MovedObject {
  std::uint32_t object = 0;  ///< Index into Scene::objects.
  glm::mat4 world_from_mesh{1};
};

/// All objects that carriers move, rising, where they are at a time [s].
std::vector<MovedObject> moved_objects(std::span<const Carrier> carriers, const Scene& scene, double seconds);

/// What moves stops nothing.
void exclude_moved_objects(std::span<const Carrier> carriers, Scene& scene);

}  // namespace brume::scene
