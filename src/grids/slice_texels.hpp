// The texels of a slice atlas. Internal to this folder; slice_atlas.hpp is the interface.
#pragma once

#include <cstdint>
#include <vector>

#include "grids/slice_atlas.hpp"

namespace brume::grids {

/// The greatest number of a texel; 0: floats.
std::uint32_t steps_of(AtlasDepth depth);

/// The values of a level: means of the voxels that a texel of it covers.
DenseGrid level_values(const DenseGrid& grid, const SliceLayout& layout, std::uint32_t level);

/// The image of a grid of the layout's size, rows from the top; `nothing` where there is no tile.
std::vector<float> texels_of(const DenseGrid& grid, const SliceLayout& layout, float nothing);
/// The values back, in the order of DenseGrid.
std::vector<float> voxels_of(const std::vector<float>& texels, const SliceLayout& layout);

/// The nearest number in [0, steps] to a value, and the value of a number.
std::uint16_t code_of(float value, const AtlasRange& range, std::uint32_t steps);
float value_of(std::uint16_t code, const AtlasRange& range, std::uint32_t steps);

}  // namespace brume::grids
