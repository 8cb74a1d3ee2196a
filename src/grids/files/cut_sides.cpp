#include "grids/files/cut_sides.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>

#include "grids/grid.hpp"

namespace brume::grids {
namespace {

// By the upper bits of floats, which rise as they do: a hundredth apart.
double densest_of(const Grid& grid) {
  constexpr int kDropped = 16;
  std::map<std::uint32_t, double> counts;
  double all = 0;
  for_each_active(grid, [&](const ActiveValue& active) {
    const double value = to_number(grid.type, active.value), count = static_cast<double>(active.count());
    if (!(value > 0) || !(value <= 1e30)) return;
    counts[std::bit_cast<std::uint32_t>(static_cast<float>(value)) >> kDropped] += count;
    all += count;
  });
  double below = 0;
  for (const auto& [key, count] : counts) {
    below += count;
    if (below >= 0.999 * all) return double{std::bit_cast<float>(key << kDropped)};
  }
  return 0;
}

// 0 where nothing is stored.
double value_at(const Grid& grid, glm::ivec3 at) {
  const glm::ivec3 within = at & 7;
  const auto brick = find_brick(grid, at - within);
  if (!brick) return 0;
  const auto voxel = static_cast<std::size_t>(within.x + 8 * (within.y + 8 * within.z));
  if (!grid.bricks[*brick].is_active(voxel)) return 0;
  return to_number(grid.type, grid.values_of(*brick).data() + voxel * bytes_of(grid.type));
}

// Whether a value ends rather than fades: nothing is beyond it, and what is before it is not much more.
bool ends(const Grid& grid, double value, glm::ivec3 at, int axis, int out) {
  glm::ivec3 beyond = at, before = at;
  beyond[axis] += out;
  before[axis] -= out;
  return value_at(grid, beyond) < 0.1 * value && value_at(grid, before) < 2 * value;
}

// Dense voxels of each layer along an axis.
using Layers = std::map<int, double>;

// A round volume may have as much as 4 / n of the largest of n layers in its last one.
double cut_part(double cut, double most, std::size_t layers) {
  const double part = cut / most;
  return part < 6.0 / static_cast<double>(layers) ? 0 : part;
}

}  // namespace

Sides cut_sides(const Grid& grid) {
  const double least = 0.1 * densest_of(grid);
  Sides sides{};
  if (!(least > 0)) return sides;
  // How much each layer of voxels holds, along each axis.
  std::array<Layers, 3> layers;
  for_each_active(grid, [&](const ActiveValue& active) {
    const double value = to_number(grid.type, active.value);
    const glm::ivec3 low = active.low;
    const auto edge = static_cast<int>(active.edge);
    if (!(value > least)) return;
    for (int axis = 0; axis < 3; ++axis)
      for (int i = 0; i < edge; ++i)
        layers[static_cast<std::size_t>(axis)][low[axis] + i] += static_cast<double>(edge) * edge;
  });
  if (layers[0].empty()) return sides;
  // How much of the first and last layers ends there, and does not fade.
  for_each_active(grid, [&](const ActiveValue& active) {
    const double value = to_number(grid.type, active.value);
    const glm::ivec3 low = active.low;
    const auto edge = static_cast<int>(active.edge);
    if (!(value > least)) return;
    for (int axis = 0; axis < 3; ++axis) {
      const Layers& counts = layers[static_cast<std::size_t>(axis)];
      const std::size_t side = 2 * static_cast<std::size_t>(axis);
      const double face = static_cast<double>(edge) * edge;
      if (low[axis] == counts.begin()->first && (edge > 1 || ends(grid, value, low, axis, -1)))
        sides[side] += face;
      if (low[axis] + edge - 1 == counts.rbegin()->first && (edge > 1 || ends(grid, value, low, axis, 1)))
        sides[side + 1] += face;
    }
  });
  // In relation to the fullest layer.
  for (std::size_t side = 0; side < sides.size(); ++side) {
    const Layers& counts = layers[side / 2];
    double most = 0;
    for (const auto& [at, count] : counts) most = std::max(most, count);
    sides[side] = cut_part(sides[side], most, counts.size());
  }
  return sides;
}

}  // namespace brume::grids
