// What is packed into a tank: its size, the spheres, where they are tried and their colours.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "core/error.hpp"
#include "spheres/tank.hpp"

namespace brume::spheres {

/// Where spheres are tried.
enum class Arrangement : std::uint32_t {
  random,         ///< Anywhere, in any order of sizes (dart throwing).
  largest_first,  ///< Anywhere, the large before the small: fills more of the tank.
  noise,          ///< Where smooth noise is high: strands and caves. The large before the small.
  coral,          ///< Touching those that are there, from seeds on the floor (y = 0) upwards, ever smaller.
};

/// Which of the palette's colours spheres take, but for the first with neighbours up to 8 % of it to both
/// sides.
enum class Coloring : std::uint32_t {
  random,  ///< Any.
  radius,  ///< By the logarithm of the radius, the least at the palette's low end.
  height,  ///< By y, the floor at the low end.
  noise,   ///< By smooth noise: patches of like colours.
};

struct PackOptions {
  glm::uvec3 size{600, 600, 200};  ///< As Tank::size.
  float voxel = 0.0025f;           ///< As Tank::voxel.
  std::uint32_t count = 65535;     ///< Number of spheres, at most kMostSpheres.
  glm::vec2 radius{1.5f, 16};      ///< Least and largest [voxels]; 0 < x <= y, 2 * y <= each axis of `size`.
  float distribution = 3;          ///< Number of spheres ~ radius^-distribution, in [0, 8].
  Arrangement arrangement = Arrangement::largest_first;
  float noise_size = 120;  ///< Size of the features of noise [voxels], in [1, 65536].
  Coloring coloring = Coloring::random;
  float opacity = 1;  ///< Opacity of all spheres, [0, 1]; 1: opaque (Color).
  std::uint64_t seed = 0;
  /// Colours from the low to the high end of the palette's range (Color without opacity). Empty: white.
  std::vector<Color> palette;
};

/// Radii of spheres where a tank gives none: as in PackOptions, less in a small tank so that they fit.
glm::vec2 default_radius(const glm::uvec3& size);

/// Number of spheres where a tank gives none: as in PackOptions, but at most as many as fill a third of the
/// tank, and at least 1. From `size`, `radius` and `distribution`, which are in range.
std::uint32_t default_count(const PackOptions& options);

/// Fails with usage for options out of range; the message begins with the member's name.
Result<void> check_options(const PackOptions& options);

}  // namespace brume::spheres
