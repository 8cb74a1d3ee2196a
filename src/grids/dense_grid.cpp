#include "grids/dense_grid.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace brume::grids {
namespace {

constexpr double kSameVoxel = 1e-6;  // [voxels]: edges nearer than this are one

/// Whether a matrix only scales, by positive numbers, and moves.
bool is_scale(const glm::dmat4& m) {
  for (int column = 0; column < 3; ++column) {
    const glm::dvec3 v(m[column]);
    if (!(v[column] > 0)) return false;
    for (int row = 0; row < 3; ++row)
      if (row != column && std::abs(v[row]) > 1e-9 * v[column]) return false;
  }
  return true;
}

/// A voxel of a grid and its part of a value.
struct Weight {
  int source = 0;
  double weight = 0;
};

/// Where the value of a voxel comes from along one axis. [begin, end): what it covers, in voxels of the grid,
/// of which i covers [i, i + 1).
std::vector<Weight> make_weights(double begin, double end) {
  const double width = end - begin;
  if (std::abs(width - 1) < kSameVoxel && std::abs(begin - std::round(begin)) < kSameVoxel)
    return {{static_cast<int>(std::round(begin)), 1}};
  if (width <= 1) {
    const double center = (begin + end) / 2 - 0.5, first = std::floor(center);
    return {{static_cast<int>(first), 1 - (center - first)}, {static_cast<int>(first) + 1, center - first}};
  }
  std::vector<Weight> weights;
  for (double i = std::floor(begin); i < end; ++i)
    weights.push_back({static_cast<int>(i), (std::min(i + 1, end) - std::max(i, begin)) / width});
  return weights;
}

/// The weights of all voxels of a box along one axis, and the same the other way round.
struct AxisWeights {
  std::vector<std::vector<Weight>> of_voxel;
  int first = 0;                               ///< The voxel of the grid at which `to_voxels` begins.
  std::vector<std::vector<Weight>> to_voxels;  ///< Weight::source is a voxel of the box.

  /// Voxels of the box that a voxel of the grid counts for.
  std::span<const Weight> of_source(int source) const {
    const int i = source - first;
    if (i < 0 || i >= static_cast<int>(to_voxels.size())) return {};
    return to_voxels[static_cast<std::size_t>(i)];
  }
  /// The weights of a run of the grid's voxels, of all voxels of the box for which they count.
  std::vector<Weight> of_run(int begin, int length) const {
    std::vector<Weight> sums;
    for (std::size_t voxel = 0; voxel < of_voxel.size(); ++voxel) {
      double sum = 0;
      for (const Weight& one : of_voxel[voxel])
        if (one.source >= begin && one.source - begin < length) sum += one.weight;
      if (sum > 0) sums.push_back({static_cast<int>(voxel), sum});
    }
    return sums;
  }
};

AxisWeights axis_weights(double first, double per_voxel, std::uint32_t count) {
  AxisWeights axis;
  int low = INT32_MAX, high = INT32_MIN;
  for (std::uint32_t i = 0; i < count; ++i) {
    axis.of_voxel.push_back(make_weights(first + i * per_voxel, first + (i + 1) * per_voxel));
    low = std::min(low, axis.of_voxel.back().front().source);
    high = std::max(high, axis.of_voxel.back().back().source);
  }
  axis.first = low;
  axis.to_voxels.resize(static_cast<std::size_t>(high - low) + 1);
  for (std::size_t voxel = 0; voxel < axis.of_voxel.size(); ++voxel)
    for (const Weight& one : axis.of_voxel[voxel])
      axis.to_voxels[static_cast<std::size_t>(one.source - low)].push_back(
          {static_cast<int>(voxel), one.weight});
  return axis;
}

/// Adds values to a box, over what it has.
class Splat {
 public:
  Splat(glm::uvec3 size, const std::array<AxisWeights, 3>& axes, double background)
      : size_(size), axes_(axes), background_(background) {
    values_.assign(std::size_t{size.x} * size.y * size.z, background);
  }

  void add(const Grid& grid, std::size_t brick) {
    const glm::ivec3 origin = grid.bricks[brick].origin;
    const std::size_t bytes = bytes_of(grid.type);
    const std::byte* const values = grid.values_of(brick).data();
    for (int voxel = 0; voxel < static_cast<int>(kBrickVoxels); ++voxel) {
      const auto at = static_cast<std::size_t>(voxel);
      double value = grid.bricks[brick].is_active(at) ? 1 : 0;
      if (grid.type != ValueType::mask) value = to_number(grid.type, values + at * bytes);
      const glm::ivec3 source = origin + glm::ivec3(voxel % 8, voxel / 8 % 8, voxel / 64);
      add(axes_[0].of_source(source.x), axes_[1].of_source(source.y), axes_[2].of_source(source.z), value);
    }
  }
  void add(const Grid& grid, const Tile& tile) {
    const double value =
        grid.type == ValueType::mask ? (tile.active ? 1.0 : 0.0) : to_number(grid.type, tile.value.data());
    const int edge = static_cast<int>(tile.edge);
    const std::array runs{axes_[0].of_run(tile.origin.x, edge), axes_[1].of_run(tile.origin.y, edge),
                          axes_[2].of_run(tile.origin.z, edge)};
    add(runs[0], runs[1], runs[2], value);
  }

  std::vector<float> values() const {
    std::vector<float> values(values_.size());
    std::ranges::transform(values_, values.begin(), [](double value) { return static_cast<float>(value); });
    return values;
  }

 private:
  void add(std::span<const Weight> x, std::span<const Weight> y, std::span<const Weight> z, double value) {
    const double more = (std::isnan(value) ? 0 : value) - background_;
    if (more == 0) return;
    for (const Weight& k : z)
      for (const Weight& j : y) {
        const std::size_t row =
            size_.x * (static_cast<std::size_t>(j.source) + size_.y * static_cast<std::size_t>(k.source));
        for (const Weight& i : x)
          values_[row + static_cast<std::size_t>(i.source)] += i.weight * j.weight * k.weight * more;
      }
  }

  glm::u64vec3 size_;
  const std::array<AxisWeights, 3>& axes_;
  double background_;
  std::vector<double> values_;
};

Failure differing_axes(const Grid& grid) {
  return {ErrorCode::bad_input,
          "grid \"" + grid.name + "\" lies along other axes than the first one; bake one grid at a time"};
}

}  // namespace

Grid to_grid(const DenseGrid& dense, const glm::dmat4& world_from_box) {
  Grid grid;
  grid.name = dense.name;
  grid.grid_class = GridClass::fog_volume;
  // Voxel 0 is centred half a voxel into the box.
  const glm::dvec3 voxel = dense.voxel_size();
  glm::dmat4 box_from_index(1);
  for (int axis = 0; axis < 3; ++axis) box_from_index[axis][axis] = voxel[axis];
  box_from_index[3] = glm::dvec4(dense.box.low + 0.5 * voxel, 1);
  grid.world_from_index = world_from_box * box_from_index;

  const glm::uvec3 bricks = (dense.size + 7u) / 8u;
  for (glm::uvec3 at(0); at.z < bricks.z; ++at.z)
    for (at.y = 0; at.y < bricks.y; ++at.y)
      for (at.x = 0; at.x < bricks.x; ++at.x) {
        Brick brick{glm::ivec3(8u * at)};
        std::array<float, kBrickVoxels> values{};
        for (std::uint32_t i = 0; i < kBrickVoxels; ++i) {
          const glm::uvec3 voxel_at = 8u * at + glm::uvec3(i % 8, i / 8 % 8, i / 64);
          if (glm::any(glm::greaterThanEqual(voxel_at, dense.size))) continue;
          values[i] = dense.values[dense.index(voxel_at)];
          brick.active[i / 64] |= std::uint64_t{1} << (i % 64);
        }
        grid.bricks.push_back(brick);
        const auto bytes = std::as_bytes(std::span(values));
        grid.values.insert(grid.values.end(), bytes.begin(), bytes.end());
      }
  return grid;
}

Result<GridBox> box_of(std::span<const Grid* const> grids) {
  GridBox found;
  if (grids.empty()) return Failure{ErrorCode::bad_input, "has no grids"};
  const Grid& first = *grids.front();
  const bool is_upright = is_scale(first.world_from_index);
  found.world_from_box = is_upright ? glm::dmat4(1) : first.world_from_index;
  // In index space of the first grid.
  Box<double> all{glm::dvec3(1e300), glm::dvec3(-1e300)};
  for (const Grid* grid : grids) {
    const Box<double> active = active_bounds(*grid);
    if (active.empty()) continue;
    const glm::dmat4 first_from_grid = glm::inverse(first.world_from_index) * grid->world_from_index;
    if (!is_scale(first_from_grid)) return differing_axes(*grid);
    all.low = glm::min(all.low, glm::dvec3(first_from_grid * glm::dvec4(active.low, 1)));
    all.high = glm::max(all.high, glm::dvec3(first_from_grid * glm::dvec4(active.high, 1)));
  }
  if (all.empty()) return Failure{ErrorCode::bad_input, "has no active voxels"};
  // Whole voxels of the first grid.
  all.low = glm::floor(all.low + 0.5 + kSameVoxel) - 0.5;
  all.high = glm::ceil(all.high + 0.5 - kSameVoxel) - 0.5;
  const glm::dvec3 size = glm::round(all.high - all.low);
  if (glm::any(glm::greaterThan(size, glm::dvec3(1 << 20))))
    return Failure{ErrorCode::resource_limit, "spans more than 2^20 voxels along an axis"};
  found.size = glm::uvec3(size);
  found.box = all;
  if (is_upright)
    found.box = {glm::dvec3(first.world_from_index * glm::dvec4(all.low, 1)),
                 glm::dvec3(first.world_from_index * glm::dvec4(all.high, 1))};
  return found;
}

Result<DenseGrid> resample(const Grid& grid, const GridBox& box) {
  const glm::dmat4 index_from_box = glm::inverse(grid.world_from_index) * box.world_from_box;
  if (!is_scale(index_from_box)) return differing_axes(grid);
  const glm::dvec3 low(index_from_box * glm::dvec4(box.box.low, 1)),
      high(index_from_box * glm::dvec4(box.box.high, 1));
  constexpr double kFarthest = 1 << 30;
  if (!(glm::all(glm::lessThan(glm::abs(low), glm::dvec3(kFarthest))) &&
        glm::all(glm::lessThan(glm::abs(high), glm::dvec3(kFarthest)))))
    return Failure{ErrorCode::bad_input, "the box is too far from grid \"" + grid.name + "\""};
  if (glm::any(glm::greaterThan(high - low, glm::dvec3(1 << 22))))
    return Failure{ErrorCode::resource_limit,
                   "the box spans more than 2^22 voxels of grid \"" + grid.name + "\" along an axis"};

  std::array<AxisWeights, 3> axes;
  for (int axis = 0; axis < 3; ++axis)
    // Voxel 0 of the grid covers [-0.5, 0.5) of its index space.
    axes[static_cast<std::size_t>(axis)] =
        axis_weights(low[axis] + 0.5, (high[axis] - low[axis]) / box.size[axis], box.size[axis]);
  const double background = grid.type == ValueType::mask ? 0 : to_number(grid.type, grid.background.data());
  Splat splat(box.size, axes, std::isnan(background) ? 0 : background);
  for (std::size_t brick = 0; brick < grid.bricks.size(); ++brick) splat.add(grid, brick);
  for (const Tile& tile : grid.tiles) splat.add(grid, tile);
  return DenseGrid{grid.name, box.size, box.box, splat.values()};
}

}  // namespace brume::grids
