// The smoke of a state as a volume grid, for files that other programs read.
#pragma once

#include "grids/grid.hpp"
#include "sim/state.hpp"
#include "smoke/drawn_smoke.hpp"

namespace brume::scenario {

/// The axis that points up in the world of a volume file. Brume's is y; z turns the grid by 90 degrees around
/// x, so that (x, y, z) becomes (x, -z, y): Blender's axes.
enum class UpAxis { y, z };

struct SmokeGridOptions {
  UpAxis up = UpAxis::y;
  float extinction = 0;  ///< At full density [1/m], for the metadata.
};

/// The densities at the centres of voxels, State::density / 255, without holes and without the noise that the
/// renderer erodes them with. A fog volume "density" of float32 whose active voxels have smoke;
/// voxel (i, j, k) is the simulation's, its world is in metres. Metadata: `time` [s] (double), `tick`
/// (int32) and `extinction` [1/m] (float).
grids::Grid smoke_grid(const sim::State& state, const SmokeGridOptions& options);

/// The most voxels of a grid of drawn smoke.
constexpr std::uint64_t kMostDrawnVoxels = std::uint64_t{1} << 27;

/// The same of the smoke as it is drawn, with noise and holes and up to walls, in voxels of any size [m] from
/// the same corner of the level: what the centres of voxels see. Active voxels are those with smoke; full
/// density is 1, the largest value 1 + erosion / 2. Of more than kMostDrawnVoxels in its bricks a failure
/// (resource_limit).
Result<grids::Grid> drawn_smoke_grid(const smoke::DrawnSmoke& smoke, float voxel_size,
                                     const SmokeGridOptions& options);

}  // namespace brume::scenario
