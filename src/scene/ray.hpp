// One ray against a scene's triangles, without any structure: for the odd question, not for pictures.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "scene/scene.hpp"

namespace brume::scene {

/// The nearest point at which the ray from `origin_world` meets a triangle (either side) of an object that
/// is voxelized; nothing when it meets none. Moeller and Trumbore 1997, in double.
std::optional<glm::vec3> first_hit(const Scene& scene, glm::vec3 origin_world, glm::vec3 direction_world);

}  // namespace brume::scene
