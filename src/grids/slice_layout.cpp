#include "grids/slice_layout.hpp"

#include <algorithm>
#include <cmath>

#include "core/checked.hpp"
#include "image/image.hpp"

namespace brume::grids {

std::optional<AtlasAxes> parse_axes(std::string_view text) {
  if (text.size() != 8 || text[2] != ' ' || text[5] != ' ') return std::nullopt;
  AtlasAxes axes;
  unsigned used = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    const char sign = text[3 * i], axis = text[3 * i + 1];
    if ((sign != '+' && sign != '-') || axis < 'x' || axis > 'z') return std::nullopt;
    axes[i] = {axis - 'x', sign == '-'};
    used |= 1u << (axis - 'x');
  }
  return used == 7 ? std::optional(axes) : std::nullopt;
}

std::string to_text(const AtlasAxes& axes) {
  std::string text;
  for (const AtlasAxis& one : axes)
    text += std::string(text.empty() ? "" : " ") + (one.reversed ? '-' : '+') + "xyz"[one.axis];
  return text;
}

glm::uvec3 SliceLayout::voxel(std::uint32_t slice, glm::uvec2 in_tile) const {
  const std::array<std::uint32_t, 3> at{in_tile.x, in_tile.y, slice};
  glm::uvec3 voxel(0);
  for (std::size_t i = 0; i < 3; ++i) {
    const std::uint32_t edge = size[axes[i].axis];
    voxel[axes[i].axis] = axes[i].reversed ? edge - 1 - at[i] : at[i];
  }
  return voxel;
}

std::optional<std::string> fault_of(const SliceLayout& layout) {
  if (glm::any(glm::equal(layout.size, glm::uvec3(0)))) return "has no voxels along one of its axes";
  if (layout.columns < 1 || layout.columns > layout.tiles())
    return std::to_string(layout.columns) + " tiles in a row; expected 1 to " +
           std::to_string(layout.tiles()) + ", the number of tiles";
  const std::uint64_t padding = 2 * std::uint64_t{layout.padding};
  const std::uint64_t width = layout.columns * (layout.tile().x + padding);
  const std::uint64_t height = layout.rows() * (layout.tile().y + padding);
  const auto texels = checked_mul(width, height);
  if (width > image::kMaxAxis || height > image::kMaxAxis || !texels || *texels > kMostAtlasTexels)
    return "its image of " + std::to_string(width) + " x " + std::to_string(height) +
           " texels is too large: at most " + std::to_string(image::kMaxAxis) + " along each axis and " +
           std::to_string(kMostAtlasTexels) + " in all; choose fewer voxels or other columns";
  return std::nullopt;
}

std::uint32_t near_square_columns(const SliceLayout& layout, bool whole_rows) {
  const glm::dvec2 tile(layout.tile() + 2 * layout.padding);
  std::uint32_t best = 1;
  double least = 1e300;
  SliceLayout tried = layout;
  for (tried.columns = 1; tried.columns <= layout.tiles(); ++tried.columns) {
    if (whole_rows && layout.tiles() % tried.columns != 0) continue;
    const glm::dvec2 size = glm::dvec2(tried.columns, tried.rows()) * tile;
    // How far from a square, and then how many places are empty.
    const double unused = tried.columns * tried.rows() - layout.tiles();
    const double badness = std::abs(std::log2(size.x / size.y)) + 0.5 * unused / layout.tiles();
    if (badness < least - 1e-9) {
      least = badness;
      best = tried.columns;
    }
  }
  return best;
}

std::uint32_t level_count(const SliceLayout& layout) {
  std::uint32_t levels = 1;
  glm::uvec2 tile = layout.tile();
  std::uint32_t padding = layout.padding;
  // Without padding a texel of the next level still covers texels of its own tile only.
  while (tile.x % 2 == 0 && tile.y % 2 == 0 && padding % 2 == 0) {
    tile /= 2u;
    padding /= 2;
    ++levels;
  }
  return levels;
}

SliceLayout level_of(const SliceLayout& layout, std::uint32_t level) {
  SliceLayout result = layout;
  for (const int direction : {0, 1}) {
    const int axis = layout.axes[static_cast<std::size_t>(direction)].axis;
    result.size[axis] = layout.size[axis] >> level;
  }
  result.padding = layout.padding >> level;
  return result;
}

}  // namespace brume::grids
