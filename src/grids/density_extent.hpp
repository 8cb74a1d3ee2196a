// Where a density can be seen, and how deep it is: a camera and an extinction are chosen by it.
#pragma once

#include "core/box.hpp"
#include "grids/brick_volume.hpp"

namespace brume::grids {

/// What lies so far from the rest that a picture of both would show neither: less than kStray of the voxels
/// along an axis, behind a gap wider than all of the rest.
inline constexpr double kStray = 0.005;

struct DensityExtent {
  /// Box around what filtering finds above a fraction of BrickVolume::densest [voxel space]; empty: there is
  /// nothing. A few hot voxels do not hide the rest, and what strays does not count.
  Box<float> seen = kEmptyBox;
  /// Box around the voxels above 0 that do not stray, as far as filtering reaches [voxel space].
  Box<float> bulk = kEmptyBox;
  double stray_part = 0;   ///< Part of the voxels above 0 that strays.
  double stray_reach = 0;  ///< How far from the bulk they are, at most [the file's world].
  /// The 95th percentile, of all columns of bricks along the axes, of the mean integral of the values along
  /// them, none of which counts as more than `densest` [value times length in the file's world].
  double depth = 0;
};
/// `seen_fraction`: in [0, 1].
DensityExtent measure_extent(const BrickVolume& density, float seen_fraction);

}  // namespace brume::grids
