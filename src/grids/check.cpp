#include "grids/check.hpp"

#include <algorithm>
#include <cmath>
#include <string>

namespace brume::grids {
namespace {

using glm::ivec3;
using Origins = std::vector<ivec3>;

constexpr const char* kNoTruth = "a boolean is neither 0 nor 1";

Failure invalid(const Grid& grid, const std::string& what) {
  return {ErrorCode::bad_input, "grid \"" + grid.name + "\": " + what};
}

bool is_aligned(ivec3 origin, std::uint32_t edge) {
  const int rest = static_cast<int>(edge) - 1;
  return ((origin.x | origin.y | origin.z) & rest) == 0;
}

bool is_invertible(const glm::dmat4& m) {
  for (int column = 0; column < 4; ++column)
    for (int row = 0; row < 4; ++row)
      if (!std::isfinite(m[column][row])) return false;
  if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1) return false;
  const double volume = glm::determinant(glm::dmat3(m));
  return std::isfinite(volume) && volume != 0;
}

// The origins of the tiles of one edge, in order.
Origins origins_of(const Grid& grid, std::uint32_t edge) {
  Origins origins;
  for (const Tile& tile : grid.tiles)
    if (tile.edge == edge) origins.push_back(tile.origin);
  return origins;
}

bool covers(const Origins& tiles, std::uint32_t edge, ivec3 origin) {
  return std::binary_search(tiles.begin(), tiles.end(), origin & ~(static_cast<int>(edge) - 1), goes_before);
}

// Cubes aligned to their edges are disjoint unless one holds the origin of another.
bool is_disjoint(const Grid& grid) {
  for (const std::uint32_t edge : {8u, 128u, 4096u}) {
    const Origins tiles = origins_of(grid, edge);
    if (tiles.empty()) continue;
    for (const Brick& brick : grid.bricks)
      if (covers(tiles, edge, brick.origin)) return false;
    for (const Tile& tile : grid.tiles)
      if (tile.edge < edge && covers(tiles, edge, tile.origin)) return false;
  }
  return true;
}

template <typename Cube>
bool is_in_order(const std::vector<Cube>& cubes) {
  for (std::size_t i = 1; i < cubes.size(); ++i)
    if (!goes_before(cubes[i - 1].origin, cubes[i].origin)) return false;
  return true;
}

bool is_truth(std::byte value) {
  return value <= std::byte{1};
}

}  // namespace

Result<void> check_layout(const Grid& grid) {
  if (!is_invertible(grid.world_from_index))
    return invalid(grid, "its transform is not affine and invertible");
  for (const Brick& brick : grid.bricks)
    if (!is_aligned(brick.origin, kBrickEdge)) return invalid(grid, "a brick is not aligned to its edge");
  for (const Tile& tile : grid.tiles) {
    if (tile.edge != 8 && tile.edge != 128 && tile.edge != 4096)
      return invalid(grid, "a tile of " + std::to_string(tile.edge) + " voxels");
    if (!is_aligned(tile.origin, tile.edge)) return invalid(grid, "a tile is not aligned to its edge");
  }
  if (!is_in_order(grid.bricks)) return invalid(grid, "its bricks are not in order");
  if (!is_in_order(grid.tiles)) return invalid(grid, "its tiles are not in order");
  if (!is_disjoint(grid)) return invalid(grid, "a tile overlaps another one or a brick");
  if (grid.type != ValueType::boolean) return {};
  const bool truths =
      is_truth(grid.background[0]) &&
      std::all_of(grid.tiles.begin(), grid.tiles.end(), [](const Tile& t) { return is_truth(t.value[0]); });
  return truths ? Result<void>() : invalid(grid, kNoTruth);
}

Result<void> check_grid(const Grid& grid) {
  if (auto layout = check_layout(grid); !layout) return layout;
  if (grid.values.size() != grid.bricks.size() * kBrickVoxels * bytes_of(grid.type))
    return invalid(grid, "its values are not as many as its voxels");
  if (grid.type == ValueType::boolean && !std::all_of(grid.values.begin(), grid.values.end(), is_truth))
    return invalid(grid, kNoTruth);
  return {};
}

Result<void> check_active(const Grid& grid, const GridLimits& limits) {
  const std::uint64_t active = count_active(grid);
  if (active <= limits.active_voxels) return {};
  return Failure{ErrorCode::resource_limit, "grid \"" + grid.name + "\" has " + std::to_string(active) +
                                                " active voxels, more than the limit of " +
                                                std::to_string(limits.active_voxels)};
}

Result<void> check_memory(std::uint64_t bytes, const GridLimits& limits) {
  if (bytes <= limits.bytes) return {};
  return Failure{ErrorCode::resource_limit, "its volumes take " + std::to_string(bytes >> 20) +
                                                " MiB, more than the limit of " +
                                                std::to_string(limits.bytes >> 20) + " MiB"};
}

}  // namespace brume::grids
