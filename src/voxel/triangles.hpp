// The triangles of a scene in world space: what the voxelizer and the surface planes are built from.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "scene/scene.hpp"

namespace brume::voxel {

/// Corners in world space [m]. Any order; points and segments are allowed.
struct Triangle {
  glm::vec3 a{0}, b{0}, c{0};
  bool operator==(const Triangle&) const = default;
};

/// The triangles of all objects that are voxelized, in the order of objects and indices, whatever the number
/// of threads. Mesh indices must be valid, as the loaders guarantee.
std::vector<Triangle> world_triangles(const scene::Scene& scene);

}  // namespace brume::voxel
