#include "grids/files/tank_grids.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>

#include "core/log.hpp"
#include "core/tasks.hpp"
#include "grids/metadata.hpp"
#include "spheres/color.hpp"
#include "spheres/paint.hpp"

namespace brume::grids {
namespace {

constexpr std::size_t kGrain = 64;  // bricks of a task

// A tank's voxels and the grid's, of which each covers factor^3.
struct Reduction {
  glm::ivec3 fine{1}, coarse{1}, bricks{1};
  int factor = 1;

  Reduction(const glm::uvec3& size, std::uint64_t most_voxels) : fine(size), coarse(size) {
    while (voxels() > std::max<std::uint64_t>(most_voxels, 1)) {
      factor *= 2;
      coarse = (fine + (factor - 1)) / factor;
    }
    bricks = (coarse + (kBrickEdge - 1)) / kBrickEdge;
  }
  std::uint64_t voxels() const {
    return std::uint64_t(coarse.x) * std::uint64_t(coarse.y) * std::uint64_t(coarse.z);
  }
  std::size_t brick_count() const {
    return std::size_t(bricks.x) * std::size_t(bricks.y) * std::size_t(bricks.z);
  }
  glm::ivec3 first_voxel(std::size_t brick) const {
    const auto i = static_cast<int>(brick);
    return kBrickEdge * glm::ivec3(i % bricks.x, i / bricks.x % bricks.y, i / (bricks.x * bricks.y));
  }
};

// One voxel of the grids.
struct TankVoxel {
  double extinction = 0;  // per voxel of the tank
  glm::vec3 albedo{0};
};

double finite_extinction(spheres::Color color) {
  static const double opaque = -std::log(1 - kOpaqueVoxel);
  return spheres::is_opaque(color) ? opaque : spheres::extinction_of(color);
}

// The mean over what a voxel covers; what is beyond the tank is empty.
TankVoxel voxel_of(const Reduction& to, const spheres::PaintedBricks& paint, const glm::ivec3& voxel) {
  const glm::ivec3 low = to.factor * voxel, high = glm::min(low + to.factor, to.fine);
  TankVoxel mean;
  for (int z = low.z; z < high.z; ++z)
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x; ++x) {
        const spheres::Color color = paint.at({x, y, z});
        if (color >> 24 == 0) continue;
        const double extinction = finite_extinction(color);
        mean.extinction += extinction;
        mean.albedo += static_cast<float>(extinction) * spheres::albedo_of(color);
      }
  if (mean.extinction > 0) mean.albedo /= static_cast<float>(mean.extinction);
  mean.extinction /= double(to.factor) * to.factor * to.factor;
  return mean;
}

// Calls visit(number in the brick, voxel) for the voxels of a brick that are inside of the grid.
template <typename Visit>
void for_voxels(const Reduction& to, const glm::ivec3& first, const Visit& visit) {
  const glm::ivec3 count = glm::min(glm::ivec3(kBrickEdge), to.coarse - first);
  for (int z = 0; z < count.z; ++z)
    for (int y = 0; y < count.y; ++y)
      for (int x = 0; x < count.x; ++x)
        visit(static_cast<std::size_t>(x + kBrickEdge * (y + kBrickEdge * z)), first + glm::ivec3(x, y, z));
}

// The bricks that cover a painted one, in order.
std::vector<std::size_t> painted_bricks(const Reduction& to, const spheres::PaintedBricks& paint) {
  static_assert(kBrickEdge == shared::kSphereBrick);
  std::vector<bool> is_painted(to.brick_count());
  const glm::ivec3 n = paint.bricks;
  for (std::size_t i = 0; i < paint.slots.size(); ++i)
    if (paint.slots[i] != spheres::PaintedBricks::kNoSlot) {
      const auto at = static_cast<int>(i);
      const glm::ivec3 brick = glm::ivec3(at % n.x, at / n.x % n.y, at / (n.x * n.y)) / to.factor;
      is_painted[static_cast<std::size_t>(brick.x + to.bricks.x * (brick.y + to.bricks.y * brick.z))] = true;
    }
  std::vector<std::size_t> bricks;
  for (std::size_t i = 0; i < is_painted.size(); ++i)
    if (is_painted[i]) bricks.push_back(i);
  return bricks;
}

// The bricks that have a voxel with opacity.
std::vector<Brick> make_bricks(const Reduction& to, const spheres::PaintedBricks& paint) {
  const std::vector<std::size_t> painted = painted_bricks(to, paint);
  std::vector<Brick> all(painted.size());
  parallel_for(all.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      all[i].origin = to.first_voxel(painted[i]);
      for_voxels(to, all[i].origin, [&](std::size_t number, const glm::ivec3& voxel) {
        if (voxel_of(to, paint, voxel).extinction > 0)
          all[i].active[number / 64] |= std::uint64_t{1} << (number % 64);
      });
    }
  });
  std::erase_if(all, [](const Brick& brick) {
    return std::all_of(brick.active.begin(), brick.active.end(),
                       [](std::uint64_t word) { return word == 0; });
  });
  return all;
}

// Fills a grid of one or three floats a voxel.
template <typename Value, typename ValueOf>
void fill_grid(Grid& grid, const Reduction& to, const spheres::PaintedBricks& paint,
               const std::vector<Brick>& bricks, const ValueOf& value_of) {
  grid.bricks = bricks;
  grid.values.resize(bricks.size() * kBrickVoxels * sizeof(Value));
  parallel_for(bricks.size(), kGrain, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      for_voxels(to, bricks[i].origin, [&](std::size_t number, const glm::ivec3& voxel) {
        if (!bricks[i].is_active(number)) return;
        const Value value = value_of(voxel_of(to, paint, voxel));
        std::memcpy(grid.values.data() + (i * kBrickVoxels + number) * sizeof(Value), &value, sizeof value);
      });
  });
}

// The two grids without voxels.
std::array<Grid, 2> empty_grids(const spheres::Tank& tank, const Reduction& to) {
  std::array<Grid, 2> grids;
  grids[0].name = "density";
  grids[0].grid_class = GridClass::fog_volume;
  grids[0].metadata = {extinction_per_metre()};
  grids[1].name = "Cd";
  grids[1].type = ValueType::vec3f;
  const double voxel = double{tank.voxel} * to.factor;
  const glm::dvec3 first = 0.5 * voxel - 0.5 * double{tank.voxel} * glm::dvec3(tank.size);
  for (Grid& grid : grids) {
    grid.world_from_index = glm::dmat4(voxel);
    grid.world_from_index[3] = glm::dvec4(first, 1);
  }
  return grids;
}

Result<std::vector<std::size_t>> positions_of(const std::array<Grid, 2>& grids, const GridChoice& choice) {
  if (!choice) return std::vector<std::size_t>{0, 1};
  const std::array<const Grid*, 2> heads{&grids[0], &grids[1]};
  return choice(heads);
}

}  // namespace

Result<GridFile> tank_grids(const spheres::Tank& tank, const std::string& name, const GridLimits& limits,
                            const GridChoice& choice) {
  const Reduction to(tank.size, limits.tank_voxels);
  std::array<Grid, 2> grids = empty_grids(tank, to);
  const auto positions = positions_of(grids, choice);
  if (!positions) return positions.failure();

  // Only as large as it may be.
  const spheres::PaintedBricks paint = spheres::paint_bricks(tank);
  const std::vector<Brick> bricks = make_bricks(to, paint);
  std::uint64_t bytes = 0, active = 0;
  for (const std::size_t position : *positions)
    bytes += bricks.size() * (sizeof(Brick) + kBrickVoxels * bytes_of(grids[position].type));
  for (const Brick& brick : bricks)
    for (const std::uint64_t word : brick.active) active += static_cast<std::uint64_t>(std::popcount(word));
  if (bytes > limits.bytes || active > limits.active_voxels)
    return Failure{ErrorCode::resource_limit, name + ": as a volume it takes " + std::to_string(bytes >> 20) +
                                                  " MiB, " + std::to_string(active) +
                                                  " voxels; more than a volume may have"};
  if (limits.is_stopped()) return Failure{ErrorCode::internal, name + ": stopped"};
  if (to.factor > 1) {
    const auto text = [](const glm::ivec3& size) {
      return std::to_string(size.x) + "x" + std::to_string(size.y) + "x" + std::to_string(size.z);
    };
    log_warning(name + ": as a volume it is shown at 1/" + std::to_string(to.factor) +
                " of its resolution, " + text(to.coarse) + " voxels; render it as a tank for all " +
                text(to.fine));
  }

  // The grids.
  GridFile file;
  const double per_metre = 1 / double{tank.voxel};
  for (const std::size_t position : *positions) {
    Grid& grid = grids[position];
    if (position == 0)
      fill_grid<float>(grid, to, paint, bricks, [&](const TankVoxel& voxel) {
        return static_cast<float>(voxel.extinction * per_metre);
      });
    else
      fill_grid<glm::vec3>(grid, to, paint, bricks, [](const TankVoxel& voxel) { return voxel.albedo; });
    file.grids.push_back(std::move(grid));
  }
  return file;
}

}  // namespace brume::grids
