// Whether a grid obeys what grid.hpp promises: every reader of a file checks its result, every writer its
// input.
#pragma once

#include "core/error.hpp"
#include "grids/grid.hpp"
#include "grids/limits.hpp"

namespace brume::grids {

/// Fails with bad_input, without the name of a file, unless the transform is affine, finite and invertible,
/// bricks and tiles are in order, aligned and disjoint, and their booleans are 0 or 1.
Result<void> check_layout(const Grid& grid);

/// Fails as check_layout does, and unless values are as many as the bricks take, their booleans 0 or 1.
Result<void> check_grid(const Grid& grid);

/// Fails with resource_limit if more voxels are active than the limits allow.
Result<void> check_active(const Grid& grid, const GridLimits& limits);

/// Fails with resource_limit if volumes take more bytes than the limits allow.
Result<void> check_memory(std::uint64_t bytes, const GridLimits& limits);

}  // namespace brume::grids
