// Where a density can be seen, and how deep it is: what a camera and an extinction are chosen by.
#pragma once

#include "core/box.hpp"
#include "grids/brick_volume.hpp"

namespace brume::grids {

struct DensityExtent {
  /// Around the voxels above a fraction of BrickVolume::densest [voxel space]; empty: there are none. A few
  /// hot voxels do not hide the rest.
  Box<float> seen = kEmptyBox;
  /// The 95th percentile, of all columns of bricks along the axes, of the mean integral of the values along
  /// them, none of which counts as more than `densest` [value times length in the file's world].
  double depth = 0;
};
/// `seen_fraction`: in [0, 1].
DensityExtent measure_extent(const BrickVolume& density, float seen_fraction);

}  // namespace brume::grids
