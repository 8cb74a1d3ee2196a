// The part of a state that reaches given boxes: what a server tells a client that may know no more.
#pragma once

#include <span>

#include "core/box.hpp"
#include "sim/state.hpp"

namespace brume::sim {

/// How far outside of a box kept items may lie [voxels]: densities between voxel centres and in wall cells
/// depend on the voxels around them.
constexpr int kFilterReach = 2;

/// The state with only the items that reach one of the boxes of voxels, each larger by kFilterReach on every
/// side: clouds and cavities with a voxel there at any tick, whole; holes whose bore passes there; grenades
/// that are there; bodies that are there or were before their last move. All else remains, such as ticks,
/// edits of the level and the number of events. A filtered state is a State like any other, with a hash of
/// its own; a world that continued it would lack the rest.
State filtered(const State& state, std::span<const Box<int>> boxes);

}  // namespace brume::sim
