#include "grids/cut_sides.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <map>

namespace brume::grids {
namespace {

// Calls `use` with the number of each box of active voxels of one value: its low corner and its edge.
void for_each_active(const Grid& grid, const std::function<void(double, glm::ivec3, int)>& use) {
  const std::size_t bytes = bytes_of(grid.type);
  for (std::size_t i = 0; i < grid.bricks.size(); ++i) {
    const Brick& brick = grid.bricks[i];
    const std::byte* values = grid.values_of(i).data();
    for (std::size_t voxel = 0; voxel < kBrickVoxels; ++voxel) {
      if (!brick.is_active(voxel)) continue;
      const auto v = static_cast<int>(voxel);
      use(number_of(grid.type, values + voxel * bytes), brick.origin + glm::ivec3(v & 7, v >> 3 & 7, v >> 6),
          1);
    }
  }
  for (const Tile& tile : grid.tiles)
    if (tile.active) use(number_of(grid.type, tile.value.data()), tile.origin, static_cast<int>(tile.edge));
}

double cube(int edge) {
  return static_cast<double>(edge) * edge * edge;
}

// By the upper bits of floats, which rise as they do: a hundredth apart.
double densest_of(const Grid& grid) {
  constexpr int kDropped = 16;
  std::map<std::uint32_t, double> counts;
  double all = 0;
  for_each_active(grid, [&](double value, glm::ivec3, int edge) {
    if (!(value > 0) || !(value <= 1e30)) return;
    counts[std::bit_cast<std::uint32_t>(static_cast<float>(value)) >> kDropped] += cube(edge);
    all += cube(edge);
  });
  double below = 0;
  for (const auto& [key, count] : counts) {
    below += count;
    if (below >= 0.999 * all) return double{std::bit_cast<float>(key << kDropped)};
  }
  return 0;
}

}  // namespace

Sides cut_sides(const Grid& grid) {
  const double least = 0.1 * densest_of(grid);
  Sides sides{};
  if (!(least > 0)) return sides;
  // Dense voxels of each layer.
  std::array<std::map<int, double>, 3> layers;
  for_each_active(grid, [&](double value, glm::ivec3 low, int edge) {
    if (!(value > least)) return;
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < edge; ++i)
        layers[static_cast<std::size_t>(axis)][low[axis] + i] += static_cast<double>(edge) * edge;
  });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto& counts = layers[axis];
    double most = 0;
    for (const auto& [at, count] : counts) most = std::max(most, count);
    if (most <= 0) continue;
    sides[2 * axis] = counts.begin()->second / most;
    sides[2 * axis + 1] = counts.rbegin()->second / most;
  }
  return sides;
}

}  // namespace brume::grids
