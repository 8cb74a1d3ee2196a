// What glows in a grid, as a few balls: the light that it casts on its surroundings.
#pragma once

#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

#include "grids/brick_volume.hpp"

namespace brume::grids {

inline constexpr std::size_t kMostGlowBalls = 8;

/// How the power of what glows depends on the value of a grid.
enum class GlowPower {
  linear,  ///< A mask: as the value.
  fourth,  ///< Heat: as its fourth power, as a black body of that temperature shines.
};

/// A part of a grid that glows as a homogeneous ball. A voxel of value v counts by its power p, v or v^4.
struct GlowBall {
  glm::dvec3 middle{0};  ///< [voxel space of the grid]
  double radius = 0;   ///< Radius of the ball with the same mean distance from the middle, squared [voxels].
  double power = 0;    ///< Sum of p over its voxels, v in stored units.
  double value = 0;    ///< Mean of v by p, likewise.
  double density = 0;  ///< Mean of the density by p, in its stored unit.
};

/// At most kMostGlowBalls, of the whole grid together; none where nothing is above 0. A part is divided in
/// two across its longest axis, the part with the most spread glow first, until it is as small as a brick.
std::vector<GlowBall> find_glow(const BrickVolume& glow, const BrickVolume& density,
                                GlowPower power = GlowPower::fourth);

/// Heat along a line of bricks through a volume.
struct GlowColumn {
  /// Integral of the fourth power of the values [value^4 times length in the file's world].
  double power = 0;
  /// Integral of the density where the values are above 0 [value times length].
  double density = 0;
};

/// All columns of bricks along the axes of the heat, as means over 8 x 8 voxels, without columns of zeros.
std::vector<GlowColumn> glow_columns(const BrickVolume& heat, const BrickVolume& density);

/// The fraction of what a homogeneous ball emits that leaves it, by its radius times its extinction (Case, de
/// Hoffmann and Placzek 1953, "Introduction to the Theory of Neutron Diffusion", 10.2).
double escape_from_ball(double optical_radius);

}  // namespace brume::grids
