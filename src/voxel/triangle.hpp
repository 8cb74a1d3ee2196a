// A triangle in world space: what the voxelizer and the surface planes are built from.
#pragma once

#include <glm/glm.hpp>

namespace brume::voxel {

/// Corners in world space [m]. Any order; points and segments are allowed.
struct Triangle {
  glm::vec3 a{0}, b{0}, c{0};
  bool operator==(const Triangle&) const = default;
};

}  // namespace brume::voxel
