#include "grids/density_extent.hpp"

#include <algorithm>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <utility>
#include <vector>

#include "core/tasks.hpp"

namespace brume::grids {
namespace {

constexpr double kDeep = 0.95;

struct ColumnBrick {
  glm::ivec3 at{0};
  double sum = 0;  // sum of its voxels
  int count = 0, seen_count = 0;
  Box<float> any = kEmptyBox, seen = kEmptyBox;  // where filtering finds more than 0, and what is seen
  bool strays = false;

  void add(float value, float least, const Box<float>& voxels, int voxel_count) {
    count += voxel_count;
    any = united(any, {voxels.low - 0.5f, voxels.high + 0.5f});
    if (!(value > least)) return;
    // Beside a voxel of 0 the value falls to the least that is seen within a voxel from the centre.
    const float beyond = std::max(0.5f - least / value, 0.0f);
    seen_count += voxel_count;
    seen = united(seen, {voxels.low - beyond, voxels.high + beyond});
  }
};

ColumnBrick uniform_column_brick(const volume::UniformBrick& brick, const BrickVolume& density, float least) {
  const float value = std::min(density.unit * glm::unpackHalf1x16(brick.texel), density.densest);
  const glm::vec3 low(shared::kBrickVoxels * brick.at);
  ColumnBrick out{brick.at, 512 * double{value}};
  if (value > 0) out.add(value, least, {low, low + float{shared::kBrickVoxels}}, 512);
  return out;
}

ColumnBrick column_brick(std::uint32_t slot, const BrickVolume& density, float least) {
  const volume::SparseVolume& volume = *density.volume;
  ColumnBrick brick{volume.brick_of(slot)};
  const auto texels = volume.texels<std::uint16_t>(volume::ChannelId{0}, slot);
  const glm::vec3 first(shared::kBrickVoxels * brick.at);
  for (int z = 0; z < 8; ++z)
    for (int y = 0; y < 8; ++y)
      for (int x = 0; x < 8; ++x) {
        const auto texel = static_cast<std::size_t>(x + 1 + 10 * (y + 1 + 10 * (z + 1)));
        const float value = density.unit * glm::unpackHalf1x16(texels[texel]);
        if (value <= 0) continue;
        brick.sum += double{std::min(value, density.densest)};
        const glm::vec3 low = first + glm::vec3(x, y, z);
        brick.add(value, least, {low, low + 1.0f}, 1);
      }
  return brick;
}

/// The bricks that are left along each axis without the outermost kStray of what is seen, or of all voxels
/// where nothing is seen.
Box<int> middle_of(const std::vector<ColumnBrick>& bricks) {
  double all = 0;
  for (const ColumnBrick& brick : bricks) all += brick.seen_count;
  const bool any = !(all > 0);
  const auto weight = [any](const ColumnBrick& brick) { return any ? brick.count : brick.seen_count; };
  if (any)
    for (const ColumnBrick& brick : bricks) all += brick.count;
  Box<int> middle{glm::ivec3(0), glm::ivec3(0)};
  std::vector<std::pair<int, int>> along;
  for (int axis = 0; axis < 3; ++axis) {
    along.clear();
    for (const ColumnBrick& brick : bricks) along.emplace_back(brick.at[axis], weight(brick));
    std::ranges::sort(along);
    const auto after = [&](const auto& list) {
      double sum = 0;
      for (const auto& [at, count] : list)
        if ((sum += count) > kStray * all) return at;
      return list.front().first;
    };
    middle.low[axis] = after(along);
    std::ranges::reverse(along);
    middle.high[axis] = after(along);
  }
  return middle;
}

/// From a box to another, along each axis; 0 where they overlap.
glm::dvec3 gap_between(const Box<float>& a, const Box<float>& b) {
  return glm::dvec3(glm::max(glm::max(b.low - a.high, a.low - b.high), glm::vec3(0)));
}

/// Finds what strays. `voxel`: edges in the file's world.
void find_strays(std::vector<ColumnBrick>& bricks, const glm::dvec3& voxel, DensityExtent& extent) {
  if (bricks.empty()) return;
  const Box<int> middle = middle_of(bricks);
  for (ColumnBrick& brick : bricks) {
    brick.strays =
        glm::any(glm::lessThan(brick.at, middle.low)) || glm::any(glm::greaterThan(brick.at, middle.high));
    if (!brick.strays) extent.bulk = united(extent.bulk, brick.any);
  }
  // What is near belongs to the bulk, and what is near that.
  for (bool grows = true; grows;) {
    grows = false;
    const Box<float> bulk = extent.bulk;
    const glm::dvec3 size = glm::dvec3(bulk.high - bulk.low) * voxel;
    const double reach = std::max({size.x, size.y, size.z});
    for (ColumnBrick& brick : bricks) {
      const glm::dvec3 gap = gap_between(bulk, brick.any) * voxel;
      if (!brick.strays || std::max({gap.x, gap.y, gap.z}) > reach) continue;
      brick.strays = false;
      extent.bulk = united(extent.bulk, brick.any);
      grows = true;
    }
  }
  double all = 0, strays = 0;
  for (const ColumnBrick& brick : bricks) {
    all += brick.count;
    if (!brick.strays) continue;
    strays += brick.count;
    extent.stray_reach =
        std::max(extent.stray_reach, glm::length(gap_between(extent.bulk, brick.any) * voxel));
  }
  extent.stray_part = strays / all;
}

/// The integrals along an axis, of columns of bricks.
void add_depths(const std::vector<ColumnBrick>& bricks, int axis, double voxel, std::vector<double>& depths) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  std::vector<std::pair<std::pair<int, int>, double>> parts;
  parts.reserve(bricks.size());
  for (const ColumnBrick& brick : bricks) parts.push_back({{brick.at[u], brick.at[v]}, brick.sum});
  std::ranges::stable_sort(parts, {}, &decltype(parts)::value_type::first);
  constexpr double kColumn = 64;  // voxels across a brick
  for (std::size_t i = 0; i < parts.size();) {
    double sum = 0;
    const auto column = parts[i].first;
    for (; i < parts.size() && parts[i].first == column; ++i) sum += parts[i].second;
    depths.push_back(sum / kColumn * voxel);
  }
}

}  // namespace

DensityExtent measure_extent(const BrickVolume& density, float seen_fraction) {
  const float least = seen_fraction * density.densest;
  const volume::SparseVolume& volume = *density.volume;
  const auto uniform = volume.uniform_bricks();
  // Sum up each brick, and drop the empty ones.
  std::vector<ColumnBrick> bricks(volume.slot_count() + uniform.size());
  parallel_for(bricks.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto slot = static_cast<std::uint32_t>(i);
      if (i >= volume.slot_count())
        bricks[i] = uniform_column_brick(uniform[i - volume.slot_count()], density, least);
      else if (volume.in_use(slot))
        bricks[i] = column_brick(slot, density, least);
    }
  });
  std::erase_if(bricks, [](const ColumnBrick& brick) { return brick.sum <= 0; });

  DensityExtent extent;
  std::vector<double> depths;
  glm::dvec3 voxel;
  for (int axis = 0; axis < 3; ++axis) voxel[axis] = glm::length(glm::dvec3(density.world_from_voxel[axis]));
  // Leave out what strays, and enclose the rest.
  find_strays(bricks, voxel, extent);
  std::erase_if(bricks, [](const ColumnBrick& brick) { return brick.strays; });
  for (const ColumnBrick& brick : bricks) extent.seen = united(extent.seen, brick.seen);
  // The depth of the deepest columns, but for a few.
  for (int axis = 0; axis < 3; ++axis) add_depths(bricks, axis, voxel[axis], depths);
  if (depths.empty()) return extent;
  const auto deep = depths.begin() +
                    static_cast<std::ptrdiff_t>(std::floor(kDeep * static_cast<double>(depths.size() - 1)));
  std::ranges::nth_element(depths, deep);
  extent.depth = *deep;
  return extent;
}

}  // namespace brume::grids
