// A tank: a box of voxels that holds balls of colour.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/error.hpp"

namespace brume::spheres {

/// A ball. In voxels, from the low corner of the tank: voxel i covers [i, i + 1).
struct Sphere {
  glm::vec3 center{0};
  float radius = 0;  ///< > 0
  bool operator==(const Sphere&) const = default;
};
static_assert(sizeof(Sphere) == 16);

/// The colour of a sphere: red, green and blue of sRGB and its opacity, a byte each, red the lowest. 255 is
/// an opaque surface; any other a is a medium of which one voxel's length blocks a / 255 of the light.
using Color = std::uint32_t;

/// Most voxels along an axis, and of a whole tank: what its images may have on every device.
constexpr std::uint32_t kMostVoxelsPerAxis = 2048;
constexpr std::uint64_t kMostVoxels = std::uint64_t{1} << 28;
/// Most spheres: what all devices have room for in one buffer, 128 MiB.
constexpr std::uint32_t kMostSpheres = std::uint32_t{1} << 23;

/// Spheres inside of a box that do not overlap. The id of sphere i is i + 1; 0 stands for none.
struct Tank {
  glm::uvec3 size{1};    ///< [voxels], each in [1, kMostVoxelsPerAxis], their product at most kMostVoxels.
  float voxel = 0.005f;  ///< Edge of a voxel [m], > 0. The middle of the tank is the origin of the world.
  std::vector<Sphere> spheres;  ///< At most kMostSpheres.
  std::vector<Color> colors;    ///< One for each of `spheres`.
};

/// Fails with resource_limit for more than a tank may have, without the name of a file.
Result<void> check_tank_size(const glm::uvec3& size, std::uint64_t spheres);
/// The same, and fails with bad_input for a tank without voxels or with spheres that are not inside of it.
/// That spheres do not overlap is not checked.
Result<void> check_tank(const Tank& tank);

}  // namespace brume::spheres
