// Boxes among voxels: how far one may go, and where it fits.
#pragma once

#include <glm/glm.hpp>

#include "voxel/bit_grid.hpp"
#include "voxel/int_box.hpp"

namespace brume::scenario {

/// An upright box in the world [m].
struct Body {
  glm::dvec3 low{0}, high{0};
  Body moved(const glm::dvec3& way) const { return {low + way, high + way}; }
};

/// Bodies stay this far from what they meet [m].
constexpr double kSkin = 1e-5;

/// Whether any voxel of a box is solid. Those below the grid's bottom are, others outside of it are not.
bool any_solid(const voxel::BitGrid& grid, const voxel::IntBox& voxels);

/// Whether the body overlaps a solid voxel; touching one is no overlap.
bool is_stuck(const voxel::BitGrid& grid, const Body& body);

/// How far a body that is not stuck may go along an axis, of `way` [m]: all of it, or up to kSkin before the
/// first solid voxel. Nothing on the way is missed.
double sweep(const voxel::BitGrid& grid, const Body& body, int axis, double way);

/// The shortest way to where the body is free, straight through whatever is in between, when it is no longer
/// than `farthest` [m]; else the one straight up.
glm::dvec3 way_out(const voxel::BitGrid& grid, const Body& body, double farthest = 4);

}  // namespace brume::scenario
