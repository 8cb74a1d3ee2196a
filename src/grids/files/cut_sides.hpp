// Sides of a volume at which it ends abruptly: a simulation that reached the walls of its domain.
#pragma once

#include <array>

#include "grids/grid.hpp"

namespace brume::grids {

/// The sides of a box in index space, in this order: -x, +x, -y, +y, -z, +z.
using Sides = std::array<double, 6>;

/// For each side of the box around all dense voxels, how many of those that touch it end there, in relation
/// to the layer parallel to it that has the most: near 1 where a volume was cut straight, 0 where it fades or
/// is round. Dense is what exceeds a tenth of the 99.9th percentile of all values above 0; it ends where
/// nothing is beyond it and no more than twice as much before it. Zeros without any.
Sides cut_sides(const Grid& grid);

/// A side counts as cut from here on.
constexpr double kCutSide = 0.25;

}  // namespace brume::grids
