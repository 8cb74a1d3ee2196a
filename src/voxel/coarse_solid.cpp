#include "voxel/coarse_solid.hpp"

#include <algorithm>
#include <bit>

namespace brume::voxel {

int coarse_edge(glm::ivec3 voxels, std::uint32_t most_cells, int most_per_axis) {
  for (int edge = 1;; ++edge) {
    const glm::u64vec3 cells(coarse_size(voxels, edge));
    const bool fits = cells.x * cells.y * cells.z <= most_cells;
    if (fits && std::max({cells.x, cells.y, cells.z}) <= static_cast<std::uint64_t>(most_per_axis))
      return edge;
  }
}

std::vector<bool> coarse_solid(const BitGrid& grid, int edge, const Box<int>& cells) {
  const glm::ivec3 size = cells.high - cells.low;
  std::vector<std::uint32_t> counts(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y) *
                                    static_cast<std::size_t>(size.z));

  // How many voxels of each cell are solid: brick by brick, bit by bit.
  const Box<int> bricks{cells.low * edge / kBrickSize,
                        (glm::min(cells.high * edge, grid.size()) + 7) / kBrickSize};
  for_each_in(bricks, [&](glm::ivec3 b) {
    const BitGrid::Brick* brick = grid.find_brick(b);
    for (int z = 0; brick && z < kBrickSize; ++z)
      for (std::uint64_t left = (*brick)[static_cast<std::size_t>(z)]; left != 0; left &= left - 1) {
        const int bit = std::countr_zero(left);
        const glm::ivec3 cell = (b * kBrickSize + glm::ivec3(bit & 7, bit >> 3, z)) / edge;
        const glm::ivec3 at = cell - cells.low;
        if (cells.contains(cell)) ++counts[static_cast<std::size_t>(at.x + size.x * (at.y + size.y * at.z))];
      }
  });

  const auto half_a_wall = static_cast<std::uint32_t>((edge * edge + 1) / 2);
  std::vector<bool> solid(counts.size());
  for (std::size_t i = 0; i < counts.size(); ++i) solid[i] = counts[i] >= half_a_wall;
  return solid;
}

}  // namespace brume::voxel
