// Where a player aims: the input of throws and shots.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "voxel/bit_grid.hpp"

namespace brume::scenario {

struct Aim {
  glm::vec3 at_world{0};       ///< The first solid point on the ray; without one, its end.
  std::optional<float> meets;  ///< Distance to that solid point [m]; nothing when there is none.
  /// The centre of the voxel where a smoke thrown from the eye to `at_world` detonates; nothing when it
  /// detonates nowhere.
  std::optional<glm::vec3> landing_world;
};

/// Traces the ray from an eye. `at_world` lies between kNearestAim and `reach` [m] from the eye, and within
/// the range of events if the eye does. A direction of length 0 or with a NaN is replaced by -z.
constexpr float kNearestAim = 0.25f;
Aim aim(const voxel::BitGrid& grid, glm::vec3 eye_world, glm::vec3 direction_world, float reach = 40);

}  // namespace brume::scenario
