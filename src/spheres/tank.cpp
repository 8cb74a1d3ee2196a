#include "spheres/tank.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace brume::spheres {
namespace {

bool is_inside(const Sphere& sphere, const glm::uvec3& size) {
  const auto radius = double{sphere.radius};
  if (!(radius > 0)) return false;
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = double{sphere.center[axis]};
    // False also for numbers that are not finite.
    if (!(at >= radius && at <= size[axis] - radius)) return false;
  }
  return true;
}

}  // namespace

Result<void> check_tank_size(const glm::uvec3& size, std::uint64_t spheres) {
  const auto too_many = [](std::uint64_t found, const std::string& what, std::uint64_t most) {
    return Failure{ErrorCode::resource_limit, "has " + std::to_string(found) + what + "; at most " +
                                                  std::to_string(most) + " are possible"};
  };
  std::uint64_t voxels = 1;
  for (int axis = 0; axis < 3; ++axis) {
    if (size[axis] > kMostVoxelsPerAxis)
      return too_many(size[axis], " voxels along an axis", kMostVoxelsPerAxis);
    voxels *= size[axis];
  }
  if (voxels > kMostVoxels) return too_many(voxels, " voxels", kMostVoxels);
  if (spheres > kMostSpheres) return too_many(spheres, " spheres", kMostSpheres);
  return {};
}

Result<void> check_tank(const Tank& tank) {
  const auto refuse = [](const std::string& why) { return Failure{ErrorCode::bad_input, why}; };
  if (const auto fits = check_tank_size(tank.size, tank.spheres.size()); !fits) return fits.failure();
  if (std::min({tank.size.x, tank.size.y, tank.size.z}) == 0) return refuse("its tank has no voxels");
  if (!std::isfinite(tank.voxel) || tank.voxel <= 0)
    return refuse("the edge of a voxel is not a number above 0");
  for (std::size_t i = 0; i < tank.spheres.size(); ++i)
    if (!is_inside(tank.spheres[i], tank.size))
      return refuse("sphere " + std::to_string(i + 1) + " is not inside of the tank");
  return {};
}

}  // namespace brume::spheres
