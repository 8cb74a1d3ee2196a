// A triangle in world space: input of the voxelizer and of the surface planes.
#pragma once

#include <glm/glm.hpp>

namespace brume::voxel {

/// Corners in world space [m], in any order. Degenerate triangles (points, segments) are allowed.
struct Triangle {
  glm::vec3 a{0}, b{0}, c{0};
  bool operator==(const Triangle&) const = default;
};

}  // namespace brume::voxel
