// The values of a grid as bricks of half floats that the renderer samples.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <optional>
#include <vector>

#include "core/error.hpp"
#include "grids/grid.hpp"
#include "grids/grid_numbers.hpp"
#include "volume/sparse_volume.hpp"

namespace brume::grids {

/// The most bricks of a volume, and the fewest to which any grid can be reduced.
inline constexpr std::uint32_t kMostVolumeBricks = 1u << 21, kFewestVolumeBricks = 8;
/// The same for entries of its page table: 128 MiB, and the entries of 8 nodes far apart.
inline constexpr std::uint32_t kMostVolumePages = 1u << 25, kFewestVolumePages = 1u << 13;

struct BrickVolumeOptions {
  /// Bricks that there is room for, at least kFewestVolumeBricks; a grid of more is averaged over 2^3 voxels,
  /// again and again, until it fits.
  std::uint32_t max_bricks = kMostVolumeBricks;
  /// The same for the entries of its page table, at least kFewestVolumePages: bricks far apart take many.
  std::uint32_t max_pages = kMostVolumePages;
  /// A grid with the same transform: bricks and bounds reach to wherever this one is above 0, too. For a
  /// density beside which something glows. Null: none.
  const Grid* also = nullptr;
  /// Whether bricks of one value are uniform (SparseVolume::uniform_bricks): they take no memory.
  bool may_be_uniform = true;
  /// Whether lower resolutions keep the mean of the fourth powers, that is the power of what glows, instead
  /// of the mean.
  bool glows = false;
  /// Not for level sets; empty: values below 0 count as 0.
  std::optional<ValueShift> shift = {};
};

/// What the values in a brick lie between.
struct ValueRange {
  float low = 0, high = 0;
  bool operator==(const ValueRange&) const = default;
};

/// Parts that a histogram divides the range of values into.
inline constexpr std::size_t kHistogramBins = 256;

/// One channel of half floats, filtered trilinearly. Bricks are stored wherever a filtered value can differ
/// from 0; bricks of one value throughout, apron included, have no texels.
struct BrickVolume {
  std::unique_ptr<volume::SparseVolume> volume;  ///< Voxel space: voxel i covers [i, i + 1).
  /// The least and the largest value that filtering can give anywhere in the brick of a slot, faces included,
  /// in stored halves. The largest bounds the extinction in it: a majorant.
  std::vector<ValueRange> ranges;
  glm::dmat4 world_from_voxel{1};  ///< To the file's world.
  float unit = 1;                  ///< Value that the bricks store as 1: a power of two.
  float low = 0, high = 0;         ///< Range of the values, as the file has them.
  float offset = 0;                ///< What all values below are less (ValueShift).
  float outside = 0;               ///< Value that filtering finds beyond the bricks.
  /// Percentiles of the values above 0, in halves: the 90th, and the 99.9th, for which single hot
  /// voxels do not count.
  float usual = 0, densest = 0;
  double sum = 0;  ///< Sum of all values.
  /// How many values above 0 are in each of kHistogramBins parts of equal length from low to high; empty
  /// without any.
  std::vector<std::uint64_t> histogram;
  glm::dvec3 mean{0};     ///< Mean place of the values, weighted by value [voxel space].
  int level = 0;          ///< Halvings of the resolution: 0 is the file's own.
  std::uint64_t odd = 0;  ///< Voxels and tiles that are NaN, infinite, or far beyond nearly all others.
  double rms_error = 0;   ///< Error of the halvings, over active voxels; 0 at level 0.
};

/// Values above 0 of a grid of numbers; the length of vectors. A level set becomes a fog that is 0 outside,
/// grows along three voxels behind the surface, and is 1 inside (as OpenVDB's sdfToFogVolume). NaN becomes 0,
/// what is infinite, or far beyond nearly all others, the largest other value; values that half floats lack
/// are stored in a larger or smaller unit. The background must be 0, or a level set's. Fails with
/// bad_input for a grid without numbers.
Result<BrickVolume> make_brick_volume(const Grid& grid, const BrickVolumeOptions& options = {});

/// The same at the first lower resolution that takes at most `max_bricks` bricks (at least
/// kFewestVolumeBricks), in the same unit and bounds: means of the stored halves, or with `glows` of
/// their fourth powers.
BrickVolume make_preview(const BrickVolume& fine, std::uint32_t max_bricks, bool glows = false);

/// The range of what filtering gives in a brick whose texels these are (SparseVolume::channel). Filtering is
/// linear along each axis between texel centres, and the faces of a brick lie in the middle between two: its
/// extremes are values at voxel centres and means of two, four or eight texels on faces. Each is exact in
/// double precision; rounding to float goes outwards.
ValueRange filtered_range(std::span<const std::uint16_t, shared::kTexelsPerBrick> texels);

}  // namespace brume::grids
