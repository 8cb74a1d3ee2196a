// The values of a grid as bricks of half floats that the renderer samples.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <memory>
#include <vector>

#include "core/error.hpp"
#include "grids/grid.hpp"
#include "volume/sparse_volume.hpp"

namespace brume::grids {

struct BrickVolumeOptions {
  /// Bricks that the device has room for; a grid of more is averaged over 2^3 voxels, again and again, until
  /// it fits.
  std::uint32_t max_bricks = 1u << 21;
  /// A grid with the same transform: bricks and bounds reach to wherever this one is above 0, too. For a
  /// density beside which something glows. Null: none.
  const Grid* also = nullptr;
};

inline constexpr std::size_t kHistogramBins = 256;

/// One channel of half floats, filtered trilinearly. Bricks are stored wherever a filtered value can differ
/// from 0.
struct BrickVolume {
  std::unique_ptr<volume::SparseVolume> volume;  ///< Voxel space: voxel i covers [i, i + 1).
  glm::dmat4 world_from_voxel{1};                ///< To the file's world.
  float unit = 1;                                ///< Value that the bricks store as 1: a power of two.
  float low = 0, high = 0;                       ///< Range of the values.
  double sum = 0;                                ///< Of all values.
  /// How many values above 0 are in each of kHistogramBins parts of equal length from low to high; empty
  /// without any.
  std::vector<std::uint64_t> histogram;
  glm::dvec3 mean{0}, deviation{0};  ///< Of the values' places, weighted by value [voxel space].
  int level = 0;                     ///< Halvings of the resolution: 0 is the file's own.
  double rms_error = 0;              ///< Of the halvings, over active voxels; 0 at level 0.
};

/// Values above 0 of a grid of numbers; the length of vectors. A level set becomes a fog that is 0 outside,
/// grows along three voxels behind the surface, and is 1 inside (as OpenVDB's sdfToFogVolume). NaN becomes 0;
/// values that half floats lack are stored in a larger or smaller unit. The background must be 0, or that of
/// a level set. Fails with bad_input for a grid without numbers, resource_limit where tiles alone are more
/// than fit at any level.
Result<BrickVolume> make_brick_volume(const Grid& grid, const BrickVolumeOptions& options = {});

}  // namespace brume::grids
