// Where a player aims: what throws and shots are made of.
#pragma once

#include <glm/glm.hpp>
#include <optional>

#include "voxel/bit_grid.hpp"

namespace brume::scenario {

struct Aim {
  glm::vec3 at_world{0};       ///< Where the ray meets something solid; else as far as it reaches.
  std::optional<float> meets;  ///< How far off that is [m]; nothing when it meets nothing.
  /// The middle of the voxel in which a smoke thrown from the eye to `at_world` goes off; nothing when it
  /// goes off nowhere.
  std::optional<glm::vec3> landing_world;
};

/// The ray from an eye. `at_world` is at least kNearestAim and at most `reach` from the eye and where events
/// may happen, as long as the eye is. A direction of length 0 or that is no number is taken for -z.
constexpr float kNearestAim = 0.25f;
Aim aim(const voxel::BitGrid& grid, glm::vec3 eye_world, glm::vec3 direction_world, float reach = 40);

}  // namespace brume::scenario
