// Intersects one ray with a scene's triangles by brute force: for occasional queries, not for rendering.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "scene/scene.hpp"

namespace brume::scene {

/// The nearest intersection of the ray from `origin_world` with a triangle (either side) of an
/// object that stops smoke; nothing when there is none. Moeller and Trumbore 1997, in double.
std::optional<glm::vec3> first_hit(const Scene& scene, glm::vec3 origin_world, glm::vec3 direction_world);

}  // namespace brume::scene
