// Geodesic chamfer distances by brute force: Dijkstra over a map, one voxel and one test at a time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <map>
#include <queue>
#include <tuple>
#include <vector>

namespace brume::reference {

struct Reached {
  std::uint32_t distance;
  std::int64_t index;  // x + size.x * (y + size.y * z)
  auto operator<=>(const Reached&) const = default;
};

/// Every free voxel that `source` reaches, by (distance, index).
inline std::vector<Reached> dijkstra(glm::ivec3 size, const std::function<bool(int, int, int)>& is_free,
                                     glm::ivec3 source) {
  const auto index_of = [&](int x, int y, int z) {
    return x + std::int64_t{size.x} * (y + std::int64_t{size.y} * z);
  };
  const auto free_inside = [&](int x, int y, int z) {
    return x >= 0 && y >= 0 && z >= 0 && x < size.x && y < size.y && z < size.z && is_free(x, y, z);
  };
  // A move from a voxel to a neighbour: every voxel of the box between the two must be free.
  const auto may_move = [&](int x, int y, int z, int dx, int dy, int dz) {
    for (int i = std::min(0, dx); i <= std::max(0, dx); ++i)
      for (int j = std::min(0, dy); j <= std::max(0, dy); ++j)
        for (int k = std::min(0, dz); k <= std::max(0, dz); ++k)
          if (!free_inside(x + i, y + j, z + k)) return false;
    return true;
  };

  std::vector<Reached> reached;
  if (!free_inside(source.x, source.y, source.z)) return reached;
  using Entry = std::tuple<std::uint32_t, int, int, int>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  std::map<std::int64_t, std::uint32_t> best;
  best[index_of(source.x, source.y, source.z)] = 0;
  open.emplace(0, source.x, source.y, source.z);
  while (!open.empty()) {
    const auto [distance, x, y, z] = open.top();
    open.pop();
    if (best[index_of(x, y, z)] != distance) continue;
    reached.push_back({distance, index_of(x, y, z)});
    for (int dx = -1; dx <= 1; ++dx)
      for (int dy = -1; dy <= 1; ++dy)
        for (int dz = -1; dz <= 1; ++dz) {
          const int axes = std::abs(dx) + std::abs(dy) + std::abs(dz);
          if (axes == 0 || !may_move(x, y, z, dx, dy, dz)) continue;
          const std::uint32_t length = distance + (axes == 1 ? 10u : axes == 2 ? 14u : 17u);
          const auto [entry, is_new] = best.try_emplace(index_of(x + dx, y + dy, z + dz), length);
          if (!is_new && entry->second <= length) continue;
          entry->second = length;
          open.emplace(length, x + dx, y + dy, z + dz);
        }
  }
  std::sort(reached.begin(), reached.end());
  return reached;
}

}  // namespace brume::reference
