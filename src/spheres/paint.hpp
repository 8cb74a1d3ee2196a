// Colours of a tank's voxels.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "shared/spheres.h"
#include "spheres/tank.hpp"

namespace brume::spheres {

/// The colour of each voxel, x fastest: the colour of the sphere whose shared::sphere_power of the voxel's
/// middle is below 0, of two that touch there the one of the lower id; 0 where none is. Row by row of each
/// sphere, on all cores; the same for any number of threads.
std::vector<Color> paint(const Tank& tank);

/// The same of those bricks of kSphereBrick^3 voxels alone that spheres touch: memory follows what is there,
/// not the size of the tank.
struct PaintedBricks {
  glm::ivec3 bricks{0};  ///< Along each axis.
  std::vector<std::uint32_t>
      slots;                  ///< Place of each brick, x fastest, in `colors`; kNoSlot: no sphere touches it.
  std::vector<Color> colors;  ///< kSphereBrick^3 of each slot, x fastest.

  static constexpr std::uint32_t kNoSlot = UINT32_MAX;
  /// The colour of a voxel of the tank.
  Color at(const glm::ivec3& voxel) const {
    constexpr int kEdge = shared::kSphereBrick;
    const glm::ivec3 brick = voxel / kEdge, in = voxel % kEdge;
    const std::uint32_t slot =
        slots[(std::size_t(brick.z) * std::size_t(bricks.y) + std::size_t(brick.y)) * std::size_t(bricks.x) +
              std::size_t(brick.x)];
    if (slot == kNoSlot) return 0;
    return colors[std::size_t{slot} * kEdge * kEdge * kEdge +
                  static_cast<std::size_t>(in.x + kEdge * (in.y + kEdge * in.z))];
  }
};
PaintedBricks paint_bricks(const Tank& tank);

}  // namespace brume::spheres
