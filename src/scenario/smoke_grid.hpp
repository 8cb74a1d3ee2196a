// The smoke of a state as a volume grid, for files that other programs read.
#pragma once

#include "grids/grid.hpp"
#include "sim/state.hpp"

namespace brume::scenario {

/// The axis that points up in the world of a volume file. Brume's is y; z turns the grid by 90 degrees around
/// x, so that (x, y, z) becomes (x, -z, y): Blender's axes.
enum class UpAxis { y, z };

struct SmokeGridOptions {
  UpAxis up = UpAxis::y;
  float extinction = 0;  ///< Of full density [1/m], for the metadata.
};

/// The densities at the centres of voxels, State::density / 255, without holes and without the noise that the
/// renderer erodes them with. A fog volume "density" of float32 whose active voxels are those with smoke;
/// voxel (i, j, k) is that of the simulation, its world is in metres. Metadata: `time` [s] (double), `tick`
/// (int32) and `extinction` [1/m] (float).
grids::Grid smoke_grid(const sim::State& state, const SmokeGridOptions& options);

}  // namespace brume::scenario
