// Where the voxels of a volume are in a slice atlas: an image whose tiles are the slices of the volume.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace brume::grids {

/// A direction of the image in the volume: along one of its axes, or against it.
struct AtlasAxis {
  int axis = 0;  ///< 0, 1, 2: x, y, z.
  bool reversed = false;
  bool operator==(const AtlasAxis&) const = default;
};

/// Directions of the columns of texels (to the right), of their rows (down), and of the tiles.
using AtlasAxes = std::array<AtlasAxis, 3>;

/// "+x -y +z": the image shows each slice as seen from +z, with y up.
inline constexpr AtlasAxes kUprightAxes{{{0, false}, {1, true}, {2, false}}};

/// From three of +x, -x, +y, -y, +z, -z, each axis once, with blanks between; nullopt: of another form.
std::optional<AtlasAxes> parse_axes(std::string_view text);
std::string to_text(const AtlasAxes& axes);

/// Tiles are in rows from the top left.
struct SliceLayout {
  glm::uvec3 size{1};             ///< Voxels along x, y and z.
  AtlasAxes axes = kUprightAxes;  ///< Each axis of the volume once.
  std::uint32_t columns = 1;      ///< Tiles in a row, [1, tiles].
  std::uint32_t padding = 0;      ///< Texels around each tile that mirror it.

  std::uint32_t size_along(int direction) const {
    return size[axes[static_cast<std::size_t>(direction)].axis];
  }
  glm::uvec2 tile() const { return {size_along(0), size_along(1)}; }  ///< Without padding.
  std::uint32_t tiles() const { return size_along(2); }
  std::uint32_t rows() const { return (tiles() + columns - 1) / columns; }
  glm::uvec2 image_size() const { return glm::uvec2(columns, rows()) * (tile() + 2 * padding); }
  /// The texel of a tile, its own first one at (padding, padding) of the tile's place.
  glm::uvec2 texel(std::uint32_t slice, glm::uvec2 in_tile) const {
    return glm::uvec2(slice % columns, slice / columns) * (tile() + 2 * padding) + padding + in_tile;
  }
  /// The voxel that a texel of a tile shows.
  glm::uvec3 voxel(std::uint32_t slice, glm::uvec2 in_tile) const;

  bool operator==(const SliceLayout&) const = default;
};

/// The most texels of an atlas: four channels of floats take 1 GiB.
inline constexpr std::uint64_t kMostAtlasTexels = std::uint64_t{1} << 26;

/// nullopt: the layout is valid and its image can be stored. Else what is wrong with it.
std::optional<std::string> fault_of(const SliceLayout& layout);

/// Columns that make the image as close to a square as its tiles allow. With `whole_rows` no place is empty:
/// the importers of engines make a slice of each.
std::uint32_t near_square_columns(const SliceLayout& layout, bool whole_rows);

/// Levels of which each halves the tiles of the one before, and their padding: all of a tile's texels stay
/// its own. 1: none besides the whole resolution.
std::uint32_t level_count(const SliceLayout& layout);
/// The layout of a level, whose voxels the halved tiles hold.
SliceLayout level_of(const SliceLayout& layout, std::uint32_t level);

}  // namespace brume::grids
