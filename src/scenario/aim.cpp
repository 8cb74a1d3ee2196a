#include "scenario/aim.hpp"

#include <algorithm>
#include <cmath>

#include "scene/events.hpp"
#include "sim/walk.hpp"
#include "voxel/traverse.hpp"

namespace brume::scenario {

Aim aim(const voxel::BitGrid& grid, glm::vec3 eye_world, glm::vec3 direction_world, float reach) {
  const float length = glm::length(direction_world);
  const bool is_direction = std::isfinite(length) && length > 0;
  const glm::vec3 direction = is_direction ? direction_world / length : glm::vec3(0, 0, -1);
  const float voxel = grid.layout().voxel_size;
  Aim result;
  if (const auto hit =
          voxel::first_solid(grid, voxel_from_world(grid.layout(), eye_world), direction, reach / voxel))
    result.meets = hit->t * voxel;
  const float distance = std::max(result.meets.value_or(reach), kNearestAim);
  constexpr auto kFarthest = static_cast<float>(scene::kFarthestEvent);
  result.at_world = glm::clamp(eye_world + distance * direction, glm::vec3(-kFarthest), glm::vec3(kFarthest));
  if (const auto landing = sim::landing_voxel(grid, eye_world, result.at_world))
    result.landing_world = world_from_voxel(grid.layout(), glm::vec3(*landing) + 0.5f);
  return result;
}

}  // namespace brume::scenario
