// The identity of a level: machines whose levels have one hash answer lines of sight alike.
#pragma once

#include <cstdint>

#include "voxel/solids.hpp"
#include "voxel/surface_planes.hpp"

namespace brume::voxel {

/// Hash of all that smoke, lines of sight and bodies depend on in a level as loaded: its layout, what each
/// voxel stops, and its surfaces. Equal levels have equal hashes on every machine, whichever grids hold their
/// roles; never 0. Takes some 60 ns for each brick with solid voxels and 1 ns for each plane.
std::uint64_t level_hash(const Solids& level, const SurfacePlanes& planes);

}  // namespace brume::voxel
