// Flipbooks: the frames of an animation as the tiles of one image, for sprites.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "image/texels.hpp"

namespace brume::image {

/// Where the tiles of a sheet are: in rows from the top left, without space between them.
struct FlipbookLayout {
  std::uint32_t columns = 8, rows = 8;  ///< Each at least 1.
  glm::uvec2 tile_px{256};              ///< Size of a tile with its gutter; above 2 * gutter.
  std::uint32_t gutter = 2;             ///< Texels along each side of a tile that hold no picture.

  std::uint32_t tiles() const { return columns * rows; }
  glm::uvec2 picture_px() const { return tile_px - 2 * gutter; }
  glm::uvec2 sheet_px() const { return tile_px * glm::uvec2(columns, rows); }
};

/// A sheet without anything in it.
Texels empty_sheet(const FlipbookLayout& layout);
/// Copies a tile to its place. `tile` has layout.tile_px texels.
void set_tile(const FlipbookLayout& layout, std::uint32_t number, const Texels& tile, Texels& sheet);
Texels tile_of(const FlipbookLayout& layout, std::uint32_t number, const Texels& sheet);
/// The picture with an empty gutter around it.
Texels with_gutter(const Texels& picture, std::uint32_t gutter);

/// From where light comes, in the space of the camera: x right, y up, z towards the eye; back is behind what
/// is seen.
enum class LightSide : std::uint32_t { right, left, top, bottom, back, front };
constexpr std::size_t kLightSides = 6;
glm::vec3 direction_of(LightSide side);

/// How bright the texels of a sheet are under one directional light from each side: numbers in the order of
/// texels, premultiplied by alpha.
using SixWayLight = std::array<std::vector<float>, kLightSides>;

/// The same under light from another direction [unit, from the texel to the light]: the sides that it comes
/// from, weighted by the squares of its components, as Unity's six-way shaders do (SixWayLighting.hlsl).
float relit(const SixWayLight& light, std::size_t texel, glm::vec3 direction);

/// The normal of a surface that would be lit alike, unit: x = (right - left) / (right + left), y likewise of
/// top and bottom, z > 0.
glm::vec3 normal_of(const SixWayLight& light, std::size_t texel);

}  // namespace brume::image
