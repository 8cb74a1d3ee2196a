// What an eye in a tank's world sees: colour and distance along each of its rays, on the CPU.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "spheres/trace.hpp"

namespace brume::spheres {

/// A pinhole, y up; rays through the middles of size.x * size.y pixels.
struct Eye {
  glm::vec3 position_world{0};       ///< [m], within 2^19 voxels of the tank's middle.
  glm::vec3 target_world{0, 0, -1};  ///< [m]; at the position: looks along -z.
  float vertical_fov = 1.0472f;      ///< [radians], (0, pi).
  glm::uvec2 size{16, 9};            ///< [pixels], each at least 1.
};

/// One ray's answer.
struct Sensed {
  /// Linear, without light: each medium's colour by what it takes of the ray, then the first opaque sphere's.
  glm::vec3 color{0};
  /// 1 - transmittance along the whole ray; 1 where it meets an opaque sphere. `color` is multiplied by it.
  float opacity = 0;
  /// The distance from the eye at which half of the ray is taken [m]: the surface of an opaque sphere, if no
  /// medium before it takes that much. Infinity where more than half passes.
  float depth = 0;
};

/// One ray from a point in the world; `direction` of any length but 0.
Sensed sense_ray(const TankView& view, const glm::vec3& position_world, const glm::vec3& direction);

/// All rays, rows from the top, on all cores. The same for any number of threads. Exact spheres, never
/// voxels.
std::vector<Sensed> sense(const TankView& view, const Eye& eye);

}  // namespace brume::spheres
