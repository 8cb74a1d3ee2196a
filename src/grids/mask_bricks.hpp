// Up to four grids of one volume as masks that the renderer tints one by one.
#pragma once

#include <memory>
#include <span>

#include "core/error.hpp"
#include "grids/brick_volume.hpp"
#include "grids/grid.hpp"

namespace brume::grids {

inline constexpr std::size_t kMostMaskGrids = 4;

/// A grid of the largest value of all masks at each voxel: it is wherever one of them is. Fails with
/// bad_input for grids that hold no numbers or whose voxels are not at the same places.
Result<Grid> joined_masks(std::span<const Grid* const> masks);

/// One channel of two half floats for up to two masks, of four for more, a mask in each, in the same bricks
/// and slots as `volume`: values at the centres of its voxels, filtered trilinearly where the voxels differ,
/// 0 where a mask has none. The masks must be the same that joined_masks was given.
std::unique_ptr<volume::SparseVolume> make_mask_bricks(std::span<const Grid* const> masks,
                                                       const BrickVolume& volume);

}  // namespace brume::grids
