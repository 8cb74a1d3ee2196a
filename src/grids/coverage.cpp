#include "grids/coverage.hpp"

#include <algorithm>
#include <cmath>

#include "grids/grid.hpp"

namespace brume::grids {
namespace {

constexpr std::size_t kMostBricks = std::size_t{1} << 18;

/// A box of indices [low, high), in one brick.
struct Part {
  glm::ivec3 brick;
  Box<int> box;
};

/// The voxels around a box of the space between voxels' centres, by brick; false where they are too many.
bool add_parts(const Box<double>& box, std::vector<Part>& parts) {
  constexpr double kFarthest = 1e9;
  const glm::dvec3 low_voxel = glm::floor(box.low), high_voxel = glm::ceil(box.high) + 1.0;
  if (!glm::all(glm::lessThan(glm::max(glm::abs(low_voxel), glm::abs(high_voxel)), glm::dvec3(kFarthest))))
    return false;
  const Box<int> voxels{glm::ivec3(low_voxel), glm::ivec3(high_voxel)};
  const Box<int> bricks{voxels.low >> 3, ((voxels.high - 1) >> 3) + 1};
  const glm::dvec3 count(bricks.high - bricks.low);
  if (count.x * count.y * count.z > static_cast<double>(kMostBricks)) return false;
  for_each_in(bricks, [&](glm::ivec3 brick) {
    parts.push_back({8 * brick, {glm::max(voxels.low, 8 * brick), glm::min(voxels.high, 8 * brick + 8)}});
  });
  return parts.size() <= 8 * kMostBricks;
}

/// Around the centres of the voxels above 0, as far as filtering reaches; of a brick or tile each.
std::vector<Box<double>> boxes_of(const Grid& grid) {
  std::vector<Box<double>> boxes;
  glm::ivec3 last(0);
  for_each_active(grid, [&](const ActiveValue& active) {
    if (!(to_number(grid.type, active.value) > 0)) return;
    const glm::ivec3 brick = active.low >> 3;
    const Box<double> box{glm::dvec3(active.low) - 1.0,
                          glm::dvec3(active.low + static_cast<int>(active.edge))};
    if (active.edge > 1 || boxes.empty() || brick != last)
      boxes.push_back(box);
    else
      boxes.back() = united(boxes.back(), box);
    last = brick;
  });
  return boxes;
}

Box<double> transformed(const glm::dmat4& matrix, const Box<double>& box) {
  glm::dvec3 low(INFINITY), high(-INFINITY);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::bvec3 side(corner & 1, corner & 2, corner & 4);
    const glm::dvec3 p(matrix * glm::dvec4(glm::mix(box.low, box.high, side), 1));
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  return {low, high};
}

}  // namespace

std::optional<Grid> make_coverage(const Grid& grid, const glm::dmat4& world_from_index) {
  const glm::dmat4 index_from_grid = glm::inverse(world_from_index) * grid.world_from_index;
  std::vector<Part> parts;
  for (const Box<double>& box : boxes_of(grid))
    if (!add_parts(transformed(index_from_grid, box), parts)) return std::nullopt;
  std::ranges::sort(parts, [](const Part& a, const Part& b) { return goes_before(a.brick, b.brick); });

  Grid covered;
  covered.name = grid.name;
  covered.type = ValueType::boolean;
  covered.world_from_index = world_from_index;
  // Bricks come in order, so that only the last one can have the next part.
  for (const Part& part : parts) {
    if (covered.bricks.empty() || covered.bricks.back().origin != part.brick) {
      if (covered.bricks.size() == kMostBricks) return std::nullopt;
      covered.bricks.push_back({part.brick});
      covered.values.resize(covered.values.size() + kBrickVoxels);
    }
    Brick& brick = covered.bricks.back();
    std::byte* const values = covered.values.data() + covered.values.size() - kBrickVoxels;
    for_each_in(part.box, [&](glm::ivec3 index) {
      const glm::ivec3 in = index - part.brick;
      brick.active[static_cast<std::size_t>(in.z)] |= std::uint64_t{1} << (in.x + 8 * in.y);
      values[in.x + 8 * (in.y + 8 * in.z)] = std::byte{1};
    });
  }
  return covered;
}

}  // namespace brume::grids
