// Grids of colours in the bricks of another volume, which the renderer samples beside it.
#pragma once

#include <array>
#include <memory>

#include "core/error.hpp"
#include "grids/brick_volume.hpp"
#include "grids/grid.hpp"

namespace brume::grids {

/// Whether a grid can hold colours: vectors of floats.
bool is_color_grid(const Grid& grid);

/// One channel of four half floats, red, green, blue and 1, in the same bricks and slots as `volume`: the
/// grid's colours at the centres of the volume's voxels, filtered trilinearly where the grids' voxels differ.
/// Only active voxels have a colour; a voxel without one gets the mean of its 26 neighbours' colours, so that
/// filtering at the rim does not darken, and is white beyond. Colours are limited to [0, 1]; NaN is 0. Fails
/// with bad_input for a grid that holds none, and a transform without an inverse.
Result<std::unique_ptr<volume::SparseVolume>> make_color_bricks(const Grid& colors,
                                                                const BrickVolume& volume);

/// Colours as three grids of numbers, as Mantaflow saves the colours of smoke.
struct ColorChannels {
  std::array<const Grid*, 3> parts{};  ///< Red, green and blue; none null.
  const Grid* density =
      nullptr;  ///< Density that the colours are multiplied by, and divided by here; null: none.
};

/// Whether colours seem to be multiplied by a density, as Blender's solver saves them: at voxels of the same
/// places, none exceeds it, and where it is low they are as much lower.
bool are_multiplied(const std::array<const Grid*, 3>& parts, const Grid& density);

/// The same of three grids: at the voxels of the first, where the others are filtered trilinearly if
/// they are at other places. A voxel has a colour where one of them is active, or the density above 0.
Result<std::unique_ptr<volume::SparseVolume>> make_color_bricks(const ColorChannels& channels,
                                                                const BrickVolume& volume);

}  // namespace brume::grids
