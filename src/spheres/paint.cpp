#include "spheres/paint.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <functional>

#include "core/tasks.hpp"
#include "spheres/brick_lists.hpp"

namespace brume::spheres {
namespace {

// Voxels are painted tile by tile, each by one thread: all of x, and of y and z so much that a tile of 600
// voxels along x (600 KiB) stays in a core's cache while the spheres in it are painted.
constexpr int kTileY = 32, kTileZ = 8;
constexpr std::size_t kListGrain = 8192;  // spheres of a task

struct TileGrid {
  glm::ivec3 size;  // size of the tank
  int y = 0, z = 0;

  explicit TileGrid(const glm::uvec3& tank_size)
      : size(tank_size), y((size.y + kTileY - 1) / kTileY), z((size.z + kTileZ - 1) / kTileZ) {}
  std::size_t count() const { return std::size_t(y) * std::size_t(z); }

  // Calls visit(tile) for those that a sphere may reach, a voxel more around it for rounding.
  template <typename Visit>
  void for_each(const Sphere& sphere, const Visit& visit) const {
    const auto tile = [](float at, int edge, int most) {
      return std::clamp(static_cast<int>(std::floor(at)) / edge, 0, most - 1);
    };
    const float reach = sphere.radius + 1;
    const glm::vec3 low = glm::max(sphere.center - reach, 0.0f), high = glm::max(sphere.center + reach, 0.0f);
    for (int k = tile(low.z, kTileZ, z); k <= tile(high.z, kTileZ, z); ++k)
      for (int j = tile(low.y, kTileY, y); j <= tile(high.y, kTileY, y); ++j)
        visit(std::size_t(k) * std::size_t(y) + std::size_t(j));
  }
};

// The spheres that may reach each tile, in any order.
struct TileLists {
  std::vector<std::uint32_t> firsts;  // where each tile begins in `spheres`, and the end
  std::vector<std::uint32_t> spheres;

  TileLists(const Tank& tank, const TileGrid& tiles) {
    std::vector<std::atomic<std::uint32_t>> ends(tiles.count());
    parallel_for(tank.spheres.size(), kListGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        tiles.for_each(tank.spheres[i], [&](std::size_t tile) { ++ends[tile]; });
    });
    firsts.push_back(0);
    for (std::atomic<std::uint32_t>& end : ends) {
      firsts.push_back(firsts.back() + end);
      end = firsts[firsts.size() - 2];
    }
    spheres.resize(firsts.back());
    parallel_for(tank.spheres.size(), kListGrain, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i)
        tiles.for_each(tank.spheres[i],
                       [&](std::size_t tile) { spheres[ends[tile]++] = static_cast<std::uint32_t>(i); });
    });
  }
};

// Voxels in memory, x fastest.
struct VoxelBox {
  glm::ivec3 low, high;
  Color* voxels;                   // the voxel at `low`
  std::size_t row = 0, slice = 0;  // from one y and one z to the next

  Color* at(const glm::ivec3& voxel) const {
    const glm::ivec3 in = voxel - low;
    return voxels + std::size_t(in.z) * slice + std::size_t(in.y) * row + std::size_t(in.x);
  }
};

// Paints a row of voxels from `row` to the box's end. Those inside of the sphere are an interval around its
// middle, since squares and sums stay in order when they are rounded: its ends are estimated, then decided
// exactly.
void paint_row(const Sphere& sphere, Color color, const glm::ivec3& row, const VoxelBox& box) {
  const auto inside = [&](int x) {
    return shared::sphere_power(packed(sphere), shared::voxel_middle({x, row.y, row.z})) < 0;
  };
  const float dy = (static_cast<float>(row.y) + 0.5f) - sphere.center.y;
  const float dz = (static_cast<float>(row.z) + 0.5f) - sphere.center.z;
  const float squared = sphere.radius * sphere.radius - dy * dy - dz * dz;
  const float half = std::sqrt(std::max(squared, 0.0f));
  // Where rounding matters most, at half = 0, it changes `half` by sqrt(2^-20 radius^2) at most, 2^-10
  // radius.
  const int more = 1 + static_cast<int>(sphere.radius / 512);
  const int end = box.high.x;
  int low = std::clamp(static_cast<int>(std::ceil(sphere.center.x - half - 0.5f)) - more, row.x, end);
  int high = std::clamp(static_cast<int>(std::floor(sphere.center.x + half - 0.5f)) + more + 1, low, end);
  while (low < high && !inside(low)) ++low;
  while (low < high && !inside(high - 1)) --high;
  std::fill_n(box.at({low, row.y, row.z}), high - low, color);
}

void paint_sphere(const Sphere& sphere, Color color, const VoxelBox& box) {
  // A voxel more for rounding.
  const glm::ivec3 from = glm::max(box.low, glm::ivec3(glm::floor(sphere.center - sphere.radius)) - 1);
  const glm::ivec3 to = glm::min(box.high, glm::ivec3(glm::floor(sphere.center + sphere.radius)) + 2);
  for (int z = from.z; z < to.z; ++z)
    for (int y = from.y; y < to.y; ++y) paint_row(sphere, color, {box.low.x, y, z}, box);
}

}  // namespace

std::vector<Color> paint(const Tank& tank) {
  const TileGrid tiles(tank.size);
  TileLists lists(tank, tiles);
  std::vector<Color> voxels(std::size_t{tank.size.x} * tank.size.y * tank.size.z);
  parallel_for(tiles.count(), 1, [&](std::size_t tile, std::size_t) {
    // The last painted stays: the lowest id.
    const auto first = lists.spheres.begin() + lists.firsts[tile];
    const auto last = lists.spheres.begin() + lists.firsts[tile + 1];
    std::sort(first, last, std::greater<>());
    const glm::ivec3 low(0, int(tile) % tiles.y * kTileY, int(tile) / tiles.y * kTileZ);
    const glm::ivec3 high =
        glm::min(glm::ivec3(tiles.size.x, low.y + kTileY, low.z + kTileZ), glm::ivec3(tiles.size));
    VoxelBox box{low, high, nullptr, tank.size.x, std::size_t{tank.size.x} * tank.size.y};
    box.voxels = voxels.data() + std::size_t(low.z) * box.slice + std::size_t(low.y) * box.row;
    for (auto i = first; i != last; ++i) paint_sphere(tank.spheres[*i], tank.colors[*i], box);
  });
  return voxels;
}

PaintedBricks paint_bricks(const Tank& tank) {
  constexpr int kEdge = shared::kSphereBrick;
  constexpr std::size_t kVoxels = std::size_t{kEdge} * kEdge * kEdge, kGrain = 64;  // bricks of a task
  // A slot for each brick with spheres.
  const BrickLists lists = list_bricks(tank);
  PaintedBricks painted{lists.bricks, std::vector(lists.ranges.size(), PaintedBricks::kNoSlot), {}};
  std::vector<std::size_t> touched;
  for (std::size_t brick = 0; brick < lists.ranges.size(); ++brick) {
    if (lists.ranges[brick].count == 0) continue;
    painted.slots[brick] = static_cast<std::uint32_t>(touched.size());
    touched.push_back(brick);
  }
  // The last painted stays: the lowest id.
  painted.colors.resize(touched.size() * kVoxels);
  parallel_for(touched.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const auto brick = static_cast<int>(touched[slot]);
      const glm::ivec3 n = lists.bricks;
      const glm::ivec3 low = kEdge * glm::ivec3(brick % n.x, brick / n.x % n.y, brick / (n.x * n.y));
      const VoxelBox box{low, glm::min(low + kEdge, glm::ivec3(tank.size)),
                         painted.colors.data() + slot * kVoxels, kEdge, std::size_t{kEdge} * kEdge};
      const shared::SphereBrick range = lists.ranges[touched[slot]];
      for (std::uint32_t i = range.count; i-- > 0;) {
        const std::uint32_t sphere = lists.spheres[range.first + i];
        paint_sphere(tank.spheres[sphere], tank.colors[sphere], box);
      }
    }
  });
  return painted;
}

}  // namespace brume::spheres
