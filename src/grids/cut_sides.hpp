// Sides of a volume at which it ends abruptly: a simulation that reached the walls of its domain.
#pragma once

#include <array>

#include "grids/grid.hpp"

namespace brume::grids {

/// The sides of a box in index space, in this order: -x, +x, -y, +y, -z, +z.
using Sides = std::array<double, 6>;

/// For each side of the box around all dense voxels, how much of the layer that touches it is dense, in
/// relation to the layer parallel to it that has the most: 0 to 1. Near 0 where a volume fades or is round, 1
/// where it was cut straight. Dense is what exceeds a tenth of the 99.9th percentile of all values above 0.
/// Zeros without any.
Sides cut_sides(const Grid& grid);

/// A side counts as cut from here on: a ball of 16 voxels across has 1/8.
constexpr double kCutSide = 0.25;

}  // namespace brume::grids
