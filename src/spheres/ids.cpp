#include "spheres/ids.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "core/tasks.hpp"

namespace brume::spheres {
namespace {

constexpr int kEdge = shared::kSphereBrick;
constexpr std::size_t kIdGrain = 64;  // bricks of a task

// Eight voxels along x at once, which compilers make vectors of. The operations on each are as in
// shared/spheres.h in the same order: squares of the three axes are computed once per sphere, (x + y) + z per
// voxel.
using Row = std::array<float, kEdge>;
using RowIds = std::array<std::uint32_t, kEdge>;

// A row's nearest four: [0] the nearest of each voxel.
struct NearestRow {
  std::array<Row, 4> powers;
  std::array<RowIds, 4> ids;
  RowIds counts;
};

struct NearestBrick {
  std::array<NearestRow, kEdge * kEdge> rows;

  void clear() {
    for (NearestRow& row : rows) {
      for (Row& powers : row.powers) powers.fill(shared::kNoPower);
      for (RowIds& ids : row.ids) ids.fill(0);
      row.counts.fill(0);
    }
  }
};

// Squares of a sphere's distances along one axis, to the cubes and to the middles of a brick's eight voxels.
struct AxisSquares {
  Row to_cube, to_middle;

  AxisSquares(float center, int first_voxel) {
    for (int i = 0; i < kEdge; ++i) {
      const auto low = static_cast<float>(first_voxel + i);
      const float outside = std::max(std::max(low - center, center - (low + 1.0f)), 0.0f);
      to_cube[static_cast<std::size_t>(i)] = outside * outside;
      const float d = (low + 0.5f) - center;
      to_middle[static_cast<std::size_t>(i)] = d * d;
    }
  }
};

// shared::nearest_add for eight voxels. Ids come in ascending order: at equal power, those before stay
// before.
void add_to_row(NearestRow& row, std::uint32_t id, const Row& cube_x, float cube_y, float cube_z, float reach,
                const Row& middle_x, float middle_y, float middle_z, float squared_radius) {
  for (std::size_t i = 0; i < kEdge; ++i) {
    const bool touches = (cube_x[i] + cube_y) + cube_z <= reach;
    const float exact = ((middle_x[i] + middle_y) + middle_z) - squared_radius;
    const float power = touches ? exact : shared::kNoPower;
    row.counts[i] += touches ? 1u : 0u;
    const float p0 = row.powers[0][i], p1 = row.powers[1][i], p2 = row.powers[2][i], p3 = row.powers[3][i];
    const std::uint32_t i0 = row.ids[0][i], i1 = row.ids[1][i], i2 = row.ids[2][i], i3 = row.ids[3][i];
    const bool b0 = power < p0, b1 = power < p1, b2 = power < p2, b3 = power < p3;
    row.powers[3][i] = b2 ? p2 : (b3 ? power : p3);
    row.ids[3][i] = b2 ? i2 : (b3 ? id : i3);
    row.powers[2][i] = b1 ? p1 : (b2 ? power : p2);
    row.ids[2][i] = b1 ? i1 : (b2 ? id : i2);
    row.powers[1][i] = b0 ? p0 : (b1 ? power : p1);
    row.ids[1][i] = b0 ? i0 : (b1 ? id : i1);
    row.powers[0][i] = b0 ? power : p0;
    row.ids[0][i] = b0 ? id : i0;
  }
}

void add_to_brick(NearestBrick& brick, std::uint32_t id, const Sphere& sphere, const glm::ivec3& first) {
  const AxisSquares x(sphere.center.x, first.x), y(sphere.center.y, first.y), z(sphere.center.z, first.z);
  const float squared_radius = sphere.radius * sphere.radius;
  const float reach = squared_radius * shared::kTouchMargin;
  for (std::size_t k = 0; k < kEdge; ++k) {
    if (z.to_cube[k] > reach) continue;
    for (std::size_t j = 0; j < kEdge; ++j) {
      // Sums only grow by rounding upwards what is added: no voxel of the row can touch.
      if (y.to_cube[j] + z.to_cube[k] > reach) continue;
      add_to_row(brick.rows[k * kEdge + j], id, x.to_cube, y.to_cube[j], z.to_cube[k], reach, x.to_middle,
                 y.to_middle[j], z.to_middle[k], squared_radius);
    }
  }
}

void store_brick(VoxelIds& ids, const NearestBrick& brick, const glm::ivec3& first) {
  const glm::ivec3 count = glm::min(glm::ivec3(kEdge), glm::ivec3(ids.size()) - first);
  for (int z = 0; z < count.z; ++z)
    for (int y = 0; y < count.y; ++y) {
      const NearestRow& row = brick.rows[static_cast<std::size_t>(z * kEdge + y)];
      for (int x = 0; x < count.x; ++x) {
        const auto i = static_cast<std::size_t>(x);
        shared::NearestIds nearest = shared::nearest_none();
        nearest.ids = {row.ids[0][i], row.ids[1][i], row.ids[2][i], row.ids[3][i]};
        nearest.count = row.counts[i];
        ids.set(first + glm::ivec3(x, y, z), shared::ids_to_store(nearest));
      }
    }
}

void store_empty(VoxelIds& ids, const glm::ivec3& first) {
  const glm::ivec3 count = glm::min(glm::ivec3(kEdge), glm::ivec3(ids.size()) - first);
  for (int z = 0; z < count.z; ++z)
    for (int y = 0; y < count.y; ++y)
      for (int x = 0; x < count.x; ++x) ids.set(first + glm::ivec3(x, y, z), glm::uvec4(0));
}

}  // namespace

VoxelIds::VoxelIds(const glm::uvec3& size, std::size_t spheres)
    : size_(size),
      words_per_voxel_(spheres <= shared::kMostShortIds ? 2 : 4),
      count_(std::size_t{size.x} * size.y * size.z * words_per_voxel_),
      words_(std::make_unique_for_overwrite<std::uint32_t[]>(count_)) {}

VoxelIds make_ids(const Tank& tank, const BrickLists& lists) {
  VoxelIds ids(tank.size, tank.spheres.size());
  parallel_for(lists.ranges.size(), kIdGrain, [&](std::size_t begin, std::size_t end) {
    const auto nearest = std::make_unique<NearestBrick>();
    for (std::size_t i = begin; i < end; ++i) {
      const auto at = static_cast<int>(i);
      const glm::ivec3 brick(at % lists.bricks.x, at / lists.bricks.x % lists.bricks.y,
                             at / (lists.bricks.x * lists.bricks.y));
      const glm::ivec3 first = kEdge * brick;
      const shared::SphereBrick range = lists.ranges[i];
      if (range.count == 0) {
        store_empty(ids, first);
        continue;
      }
      nearest->clear();
      for (std::uint32_t k = range.first; k < range.first + range.count; ++k)
        add_to_brick(*nearest, lists.spheres[k] + 1, tank.spheres[lists.spheres[k]], first);
      store_brick(ids, *nearest, first);
    }
  });
  return ids;
}

}  // namespace brume::spheres
