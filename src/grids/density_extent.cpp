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
  double sum = 0;  // of its voxels
  Box<float> seen = kEmptyBox;
};

ColumnBrick uniform_column_brick(const volume::UniformBrick& brick, const BrickVolume& density, float least) {
  const float value = std::min(density.unit * glm::unpackHalf1x16(brick.texel), density.densest);
  const glm::vec3 low(shared::kBrickVoxels * brick.at);
  ColumnBrick out{brick.at, 512 * double{value}};
  if (value > least) out.seen = {low, low + float{shared::kBrickVoxels}};
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
        if (value > least) brick.seen = united(brick.seen, {low, low + 1.0f});
      }
  return brick;
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
  for (const ColumnBrick& brick : bricks) extent.seen = united(extent.seen, brick.seen);
  for (int axis = 0; axis < 3; ++axis)
    add_depths(bricks, axis, glm::length(glm::dvec3(density.world_from_voxel[axis])), depths);
  if (depths.empty()) return extent;
  const auto deep = depths.begin() +
                    static_cast<std::ptrdiff_t>(std::floor(kDeep * static_cast<double>(depths.size() - 1)));
  std::ranges::nth_element(depths, deep);
  extent.depth = *deep;
  return extent;
}

}  // namespace brume::grids
