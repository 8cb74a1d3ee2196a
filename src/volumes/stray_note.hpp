// Voxels of a volume that lie far from the rest.
#pragma once

#include <string>

#include "core/error.hpp"
#include "grids/grid.hpp"

namespace brume::volumes {

/// What is less dense is not seen.
constexpr float kSeen = 0.01f;

/// What lies far outside of the picture, a sentence; empty: nothing. The part of the voxels that strays and
/// how far it reaches: grids::DensityExtent.
std::string stray_note(double stray_part, double stray_reach);
/// The same of a grid of density.
Result<std::string> stray_note(const grids::Grid& density);

}  // namespace brume::volumes
