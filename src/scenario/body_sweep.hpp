// Collision of boxes with voxels: swept motion, and finding free space.
#pragma once

#include <glm/glm.hpp>

#include "core/box.hpp"
#include "voxel/bit_grid.hpp"

namespace brume::scenario {

/// An upright box in the world [m].
struct Body {
  glm::dvec3 low{0}, high{0};
  Body moved(const glm::dvec3& offset) const { return {low + offset, high + offset}; }
};

/// Distance that bodies keep from obstacles [m].
constexpr double kSkin = 1e-5;

/// Whether any voxel of a box is solid. Voxels below the grid's bottom count as solid, others outside as
/// free.
bool any_solid(const voxel::BitGrid& grid, const Box<int>& voxels);

/// Whether the body overlaps a solid voxel; touching is no overlap.
bool is_stuck(const voxel::BitGrid& grid, const Body& body);

/// How far a body that is not stuck can move along an axis, out of `distance` [m], signed: all of it, or up
/// to kSkin before the first solid voxel. Exact for any distance: nothing is tunnelled through.
double sweep(const voxel::BitGrid& grid, const Body& body, int axis, double distance);

/// The shortest displacement to where the body is free, regardless of what lies in between, if it is no
/// longer than `farthest` [m]; otherwise the shortest one straight up.
glm::dvec3 offset_to_free_space(const voxel::BitGrid& grid, const Body& body, double farthest = 4);

}  // namespace brume::scenario
