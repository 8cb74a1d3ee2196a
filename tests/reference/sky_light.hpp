// Sky light in a grid of voxels by brute force: ray by ray in double precision.
#pragma once

#include <cmath>
#include <glm/glm.hpp>
#include <glm/gtc/constants.hpp>

#include "voxel/bit_grid.hpp"

namespace brume::reference {

/// Whether a ray from a point (voxel space) leaves the grid without a solid voxel along the path: sampled
/// every 1/64 of a voxel.
inline bool sees_sky(const voxel::BitGrid& grid, glm::dvec3 p_voxel, glm::dvec3 direction) {
  for (;; p_voxel += direction / 64.0) {
    const glm::ivec3 v(glm::floor(p_voxel));
    if (!grid.contains(v)) return true;
    if (grid.solid(v)) return false;
  }
}

/// The texels on a ray from a voxel's centre as they are where it crosses the middle planes of its longest
/// axis.
inline bool sees_sky_step_by_step(const voxel::BitGrid& grid, glm::ivec3 voxel, glm::dvec3 direction) {
  const glm::dvec3 size = glm::abs(direction);
  const glm::dvec3 step = direction / std::max(size.x, std::max(size.y, size.z));
  for (int i = 0;; ++i) {
    const glm::ivec3 v(glm::floor(glm::dvec3(voxel) + 0.5 + step * static_cast<double>(i)));
    if (!grid.contains(v)) return true;
    if (grid.solid(v)) return false;
  }
}

/// Visible fraction of a uniform sky at a point: `rings` x 2 `rings` directions, even in solid angle.
inline double sky_fraction(const voxel::BitGrid& grid, glm::dvec3 p_voxel, int rings) {
  int visible = 0;
  for (int j = 0; j < rings; ++j)
    for (int i = 0; i < 2 * rings; ++i) {
      const double y = 1 - (2 * j + 1.0) / rings, around = glm::pi<double>() * (i + 0.5) / rings;
      const double aside = std::sqrt(1 - y * y);
      visible += sees_sky(grid, p_voxel, {aside * std::cos(around), y, aside * std::sin(around)});
    }
  return visible / (2.0 * rings * rings);
}

}  // namespace brume::reference
