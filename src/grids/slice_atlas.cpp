#include "grids/slice_atlas.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "grids/slice_texels.hpp"

namespace brume::grids {

const char* name_of(AtlasDepth depth) {
  constexpr std::array kNames{"unorm8", "unorm16", "half", "float32"};
  return kNames.at(static_cast<std::size_t>(depth));
}

std::uint32_t steps_of(AtlasDepth depth) {
  return depth == AtlasDepth::unorm8 ? 255 : depth == AtlasDepth::unorm16 ? 65535 : 0;
}

AtlasRange range_of(const DenseGrid& grid) {
  float low = 0, high = 0;
  for (const float value : grid.values) {
    low = value < low ? value : low;
    high = value > high ? value : high;
  }
  if (low >= 0 && high <= 1) return {0, 1};
  return {low, high};
}

std::optional<std::string> fault_of(const SliceAtlas& atlas) {
  if (auto fault = fault_of(atlas.layout)) return fault;
  if (atlas.channels.empty() || atlas.channels.size() > kMostAtlasChannels)
    return std::to_string(atlas.channels.size()) + " channels; an image holds 1 to 4";
  BRUME_ASSERT(atlas.ranges.size() == atlas.channels.size(), "");
  const Box<double>& box = atlas.channels.front().box;
  if (!glm::all(glm::lessThan(box.low, box.high)) ||
      !glm::all(glm::lessThan(box.high - box.low, glm::dvec3(1e30))))
    return "its box is empty or infinite";
  for (std::size_t i = 0; i < atlas.channels.size(); ++i) {
    const DenseGrid& grid = atlas.channels[i];
    BRUME_ASSERT(grid.size == atlas.layout.size && grid.box == box, grid.name);
    const auto [low, high] = atlas.ranges[i];
    if (!std::isfinite(low) || !std::isfinite(high) || !(low < high) || !std::isfinite(high - low))
      return "the range of channel \"" + grid.name +
             "\" is empty or infinite; its low end lies below its high";
    // A float holds 24 bits: a step of the range is then at least four of the floats' own.
    const float largest = std::max(std::abs(low), std::abs(high));
    if (const auto steps = static_cast<float>(steps_of(atlas.depth));
        largest * steps > (high - low) * 0x1p22f)
      return "the range of channel \"" + grid.name + "\" is too narrow beside its values for " +
             name_of(atlas.depth) + "; store floats in an .exr file";
  }
  return std::nullopt;
}

DenseGrid level_values(const DenseGrid& grid, const SliceLayout& layout, std::uint32_t level) {
  if (level == 0) return grid;
  const SliceLayout smaller = level_of(layout, level);
  const glm::uvec3 part = layout.size / smaller.size;
  DenseGrid result{grid.name, smaller.size, grid.box, {}};
  result.values.reserve(std::size_t{smaller.size.x} * smaller.size.y * smaller.size.z);
  for (glm::uvec3 at(0); at.z < smaller.size.z; ++at.z)
    for (at.y = 0; at.y < smaller.size.y; ++at.y)
      for (at.x = 0; at.x < smaller.size.x; ++at.x) {
        double sum = 0;
        for (glm::uvec3 in(0); in.z < part.z; ++in.z)
          for (in.y = 0; in.y < part.y; ++in.y)
            for (in.x = 0; in.x < part.x; ++in.x)
              sum += static_cast<double>(grid.values[grid.index(at * part + in)]);
        result.values.push_back(static_cast<float>(sum / (part.x * part.y * part.z)));
      }
  return result;
}

namespace {

/// The texel that padding shows: mirrored, so that the mean of two texels beside the rim is that of the two
/// inside of it, in levels that an engine makes.
std::uint32_t mirrored(std::int64_t at, std::uint32_t edge) {
  if (at < 0) at = -1 - at;
  if (at >= edge) at = 2 * std::int64_t{edge} - 1 - at;
  return static_cast<std::uint32_t>(std::clamp<std::int64_t>(at, 0, edge - 1));
}

}  // namespace

std::vector<float> texels_of(const DenseGrid& grid, const SliceLayout& layout, float nothing) {
  const glm::uvec2 size = layout.image_size(), tile = layout.tile(), place = tile + 2 * layout.padding;
  std::vector<float> texels(std::size_t{size.x} * size.y, nothing);
  for (std::uint32_t slice = 0; slice < layout.tiles(); ++slice) {
    const glm::uvec2 first = glm::uvec2(slice % layout.columns, slice / layout.columns) * place;
    for (glm::uvec2 at(0); at.y < place.y; ++at.y)
      for (at.x = 0; at.x < place.x; ++at.x) {
        const glm::uvec2 in_tile(mirrored(std::int64_t{at.x} - layout.padding, tile.x),
                                 mirrored(std::int64_t{at.y} - layout.padding, tile.y));
        texels[first.x + at.x + std::size_t{size.x} * (first.y + at.y)] =
            grid.values[grid.index(layout.voxel(slice, in_tile))];
      }
  }
  return texels;
}

std::vector<float> voxels_of(const std::vector<float>& texels, const SliceLayout& layout) {
  std::vector<float> values(std::size_t{layout.size.x} * layout.size.y * layout.size.z);
  const glm::uvec2 size = layout.image_size(), tile = layout.tile();
  for (std::uint32_t slice = 0; slice < layout.tiles(); ++slice)
    for (glm::uvec2 at(0); at.y < tile.y; ++at.y)
      for (at.x = 0; at.x < tile.x; ++at.x) {
        const glm::uvec2 texel = layout.texel(slice, at);
        const glm::uvec3 voxel = layout.voxel(slice, at);
        values[voxel.x + std::size_t{layout.size.x} * (voxel.y + std::size_t{layout.size.y} * voxel.z)] =
            texels[texel.x + std::size_t{size.x} * texel.y];
      }
  return values;
}

std::uint16_t code_of(float value, const AtlasRange& range, std::uint32_t steps) {
  const double low = static_cast<double>(range.low), high = static_cast<double>(range.high);
  const double position = (static_cast<double>(value) - low) / (high - low);
  // NaN fails both comparisons.
  return static_cast<std::uint16_t>(std::lround(steps * (position > 0 ? std::min(position, 1.0) : 0.0)));
}

float value_of(std::uint16_t code, const AtlasRange& range, std::uint32_t steps) {
  const double low = static_cast<double>(range.low), high = static_cast<double>(range.high);
  return static_cast<float>(low + (high - low) * code / steps);
}

GridFile to_grids(const SliceAtlas& atlas) {
  GridFile file;
  for (const DenseGrid& channel : atlas.channels)
    file.grids.push_back(to_grid(channel, atlas.world_from_box));
  return file;
}

}  // namespace brume::grids
