// Tanks of spheres as volume grids.
#pragma once

#include "core/error.hpp"
#include "grids/grid.hpp"
#include "grids/limits.hpp"
#include "spheres/tank.hpp"

namespace brume::grids {

/// Opacity of one voxel of an opaque sphere in a volume, whose extinction is finite: it passes 2^-10, less
/// than a step of a picture of 10 bits, and still less than the most opaque medium, 1/255.
inline constexpr double kOpaqueVoxel = 1 - 0x1p-10;

/// The painted voxels of a tank (spheres::paint) in the world, its middle at the origin: `density`, the
/// extinction [1/m] that their opacity means, and `Cd`, their linear colours. Voxels without opacity are
/// inactive. A tank of more than limits.tank_voxels is averaged over 2^3 voxels, again and again, until it
/// fits, and its Cd weighted by extinction, with a warning that has `name`. With `choice`, other grids are
/// not made. Fails with resource_limit beyond the other limits, and as `choice`.
Result<GridFile> tank_grids(const spheres::Tank& tank, const std::string& name, const GridLimits& limits = {},
                            const GridChoice& choice = {});

}  // namespace brume::grids
