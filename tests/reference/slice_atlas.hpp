// A volume in double precision, and where an atlas of its slices has what.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/glm.hpp>
#include <vector>

namespace brume::reference {

struct TexelVolume {
  glm::ivec3 size{1};
  std::vector<glm::dvec4> texels;  // x first, then y, then z

  /// A texel, or that at the nearest edge.
  const glm::dvec4& at(glm::ivec3 texel) const {
    const glm::ivec3 inside = glm::clamp(texel, glm::ivec3(0), size - 1);
    return texels[static_cast<std::size_t>(inside.x + size.x * (inside.y + size.y * inside.z))];
  }

  /// Trilinear between the centres of the texels, clamped to the edges.
  glm::dvec4 sample(glm::dvec3 uvw) const {
    const glm::dvec3 position = uvw * glm::dvec3(size) - 0.5;
    const glm::ivec3 first = glm::ivec3(glm::floor(position));
    glm::dvec4 sum(0);
    for (int z = 0; z < 2; ++z)
      for (int y = 0; y < 2; ++y)
        for (int x = 0; x < 2; ++x) {
          const glm::ivec3 texel = first + glm::ivec3(x, y, z);
          const glm::dvec3 away = glm::abs(position - glm::dvec3(texel));
          sum += (1 - away.x) * (1 - away.y) * (1 - away.z) * at(texel);
        }
    return sum;
  }
};

struct SliceAtlas {
  glm::ivec2 tile_texels{1};
  int padding = 0, tile_count = 1, columns = 1;

  glm::ivec2 pitch() const { return tile_texels + 2 * padding; }
  int rows() const {
    int rows = 1;
    while (rows * columns < tile_count) ++rows;
    return rows;
  }
  glm::ivec2 size() const { return pitch() * glm::ivec2(columns, rows()); }
  /// The first texel of a tile behind its padding: tiles are counted row by row.
  glm::ivec2 first_texel(int tile) const {
    glm::ivec2 at(0);
    for (int i = 0; i < tile; ++i)
      if (++at.x == columns) at = {0, at.y + 1};
    return at * pitch() + padding;
  }

  /// The weight of a tile at w, from the first slice (0) to the last (1).
  double weight(int tile, double w) const {
    const double nearest = std::clamp(w * tile_count, 0.5, tile_count - 0.5);
    return std::max(0.0, 1 - std::abs(nearest - (tile + 0.5)));
  }
};

}  // namespace brume::reference
