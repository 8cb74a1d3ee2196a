#include "image/flipbook.hpp"

#include <algorithm>
#include <cmath>

namespace brume::image {

Texels empty_sheet(const FlipbookLayout& layout) {
  const glm::uvec2 size = layout.sheet_px();
  return {size.x, size.y, std::vector<glm::vec4>(std::size_t{size.x} * size.y, glm::vec4(0))};
}

Texels tile_of(const FlipbookLayout& layout, std::uint32_t number, const Texels& sheet) {
  const glm::uvec2 size = layout.tile_px;
  const glm::uvec2 corner = size * glm::uvec2(number % layout.columns, number / layout.columns);
  Texels tile{size.x, size.y, std::vector<glm::vec4>(std::size_t{size.x} * size.y)};
  for (std::uint32_t y = 0; y < size.y; ++y)
    std::copy_n(sheet.rgba.begin() + (std::ptrdiff_t{corner.y} + y) * sheet.width + corner.x, size.x,
                tile.rgba.begin() + std::ptrdiff_t{y} * size.x);
  return tile;
}

void set_tile(const FlipbookLayout& layout, std::uint32_t number, const Texels& tile, Texels& sheet) {
  const glm::uvec2 corner = layout.tile_px * glm::uvec2(number % layout.columns, number / layout.columns);
  for (std::uint32_t y = 0; y < tile.height; ++y)
    std::copy_n(tile.rgba.begin() + std::ptrdiff_t{y} * tile.width, tile.width,
                sheet.rgba.begin() + (std::ptrdiff_t{corner.y} + y) * sheet.width + corner.x);
}

Texels with_gutter(const Texels& picture, std::uint32_t gutter) {
  const FlipbookLayout one{1, 1, glm::uvec2(picture.width, picture.height) + 2 * gutter, 0};
  Texels tile = empty_sheet(one);
  for (std::uint32_t y = 0; y < picture.height; ++y)
    std::copy_n(picture.rgba.begin() + std::ptrdiff_t{y} * picture.width, picture.width,
                tile.rgba.begin() + (std::ptrdiff_t{gutter} + y) * tile.width + gutter);
  return tile;
}

glm::vec3 direction_of(LightSide side) {
  switch (side) {
    case LightSide::right:
      return {1, 0, 0};
    case LightSide::left:
      return {-1, 0, 0};
    case LightSide::top:
      return {0, 1, 0};
    case LightSide::bottom:
      return {0, -1, 0};
    case LightSide::back:
      return {0, 0, -1};
    case LightSide::front:
      break;
  }
  return {0, 0, 1};
}

float relit(const SixWayLight& light, std::size_t texel, glm::vec3 direction) {
  float sum = 0;
  for (std::size_t side = 0; side < kLightSides; ++side) {
    const float cosine = std::max(glm::dot(direction, direction_of(static_cast<LightSide>(side))), 0.0f);
    sum += cosine * cosine * light[side][texel];
  }
  return sum;
}

glm::vec3 normal_of(const SixWayLight& light, std::size_t texel) {
  const auto slope = [&](LightSide high, LightSide low) {
    const float a = std::max(light[static_cast<std::size_t>(high)][texel], 0.0f);
    const float b = std::max(light[static_cast<std::size_t>(low)][texel], 0.0f);
    return a + b > 0 ? (a - b) / (a + b) : 0.0f;
  };
  constexpr float kSteepest = 0.98f;
  glm::vec2 across(slope(LightSide::right, LightSide::left), slope(LightSide::top, LightSide::bottom));
  if (const float length = glm::length(across); length > kSteepest) across *= kSteepest / length;
  return {across, std::sqrt(1 - glm::dot(across, across))};
}

}  // namespace brume::image
