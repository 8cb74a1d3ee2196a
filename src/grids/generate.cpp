#include "grids/generate.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/error.hpp"
#include "core/progress.hpp"
#include "core/tasks.hpp"

namespace brume::grids {
namespace {

/// Where a shape can have density, by the distance from the origin.
struct Shell {
  double full = -1;  ///< Up to here density is 1 [m].
  double end = 0;    ///< From here on it is 0 [m].
};

Shell make_shell(const CloudSettings& settings) {
  // What rounding to float may move a surface by is far below this fraction.
  constexpr double kSlack = 1e-4;
  const double r = settings.radius;
  if (settings.kind == CloudKind::slab) return {-1, r * std::sqrt(2 + 1.0 / 16) * (1 + kSlack)};
  double displacement = 0, weight = 1;
  if (settings.kind == CloudKind::pyroclastic)
    for (std::uint32_t i = 0; i < settings.octaves; ++i, weight *= settings.gain)
      displacement += settings.amplitude * r * weight * double{shared::kLatticeNoiseLimit};
  const double full = settings.kind == CloudKind::torus ? -1 : r * (1 - kSlack) - settings.edge_width;
  return {full, (r + displacement) * (1 + kSlack)};
}

/// Distances from the origin to the nearest and the farthest voxel centre of a brick [m].
std::array<double, 2> distances_of(const CloudSettings& settings, glm::ivec3 first_voxel) {
  const glm::dvec3 low =
      (glm::dvec3(first_voxel) - 0.5 * (static_cast<double>(settings.edge) - 1)) * settings.voxel_size;
  const glm::dvec3 high = low + double{kBrickEdge - 1} * settings.voxel_size;
  const glm::dvec3 near = glm::max(glm::max(low, -high), glm::dvec3(0));
  return {glm::length(near), glm::length(glm::max(glm::abs(low), glm::abs(high)))};
}

/// The bricks of one layer along z that may hold density, in the order of Grid::bricks.
std::vector<glm::ivec3> bricks_of_layer(const CloudSettings& settings, const Shell& shell, int z) {
  std::vector<glm::ivec3> found;
  const int edge = static_cast<int>(settings.edge);
  for (int y = 0; y < edge; y += kBrickEdge)
    for (int x = 0; x < edge; x += kBrickEdge)
      if (distances_of(settings, {x, y, z})[0] < shell.end) found.emplace_back(x, y, z);
  return found;
}

bool is_full(const CloudSettings& settings, const Shell& shell, glm::ivec3 first_voxel) {
  const bool whole =
      glm::all(glm::lessThanEqual(first_voxel + kBrickEdge, glm::ivec3(static_cast<int>(settings.edge))));
  return whole && distances_of(settings, first_voxel)[1] < shell.full;
}

std::array<std::uint64_t, 8> active_of(std::span<const float> values) {
  std::array<std::uint64_t, 8> active{};
  for (std::size_t i = 0; i < values.size(); ++i) active[i / 64] |= std::uint64_t{values[i] > 0} << (i % 64);
  return active;
}

/// Appends the bricks that have active voxels.
void append(Grid& grid, std::span<const glm::ivec3> first_voxels, std::span<const float> values) {
  for (std::size_t i = 0; i < first_voxels.size(); ++i) {
    const std::span<const float> of_brick = values.subspan(i * kBrickVoxels, kBrickVoxels);
    const Brick brick{first_voxels[i], active_of(of_brick)};
    if (std::ranges::all_of(brick.active, [](std::uint64_t word) { return word == 0; })) continue;
    grid.bricks.push_back(brick);
    const auto bytes = std::as_bytes(of_brick);
    grid.values.insert(grid.values.end(), bytes.begin(), bytes.end());
  }
}

/// All bricks of a layer: those without a surface are filled, the others evaluated.
void append_layer(Grid& grid, const CloudSettings& settings, const Shell& shell, int z,
                  const CloudEvaluator& evaluate) {
  const std::vector<glm::ivec3> bricks = bricks_of_layer(settings, shell, z);
  std::vector<glm::ivec3> open;
  for (const glm::ivec3 brick : bricks)
    if (!is_full(settings, shell, brick)) open.push_back(brick);
  std::vector<float> evaluated(open.size() * kBrickVoxels);
  evaluate(cloud_params(settings), open, evaluated);

  std::vector<float> values(bricks.size() * kBrickVoxels, 1.0f);
  for (std::size_t i = 0, next = 0; i < bricks.size(); ++i)
    if (next < open.size() && bricks[i] == open[next])
      std::copy_n(evaluated.begin() + static_cast<std::ptrdiff_t>(next++ * kBrickVoxels), kBrickVoxels,
                  values.begin() + static_cast<std::ptrdiff_t>(i * kBrickVoxels));
  append(grid, bricks, values);
}

}  // namespace

shared::CloudParams cloud_params(const CloudSettings& settings) {
  shared::CloudShape shape{};
  shape.kind = static_cast<std::uint32_t>(settings.kind);
  shape.radius = static_cast<float>(settings.radius);
  shape.per_edge = settings.edge_width > 0 ? static_cast<float>(1 / settings.edge_width) : 0;
  shape.amplitude = static_cast<float>(settings.amplitude * settings.radius);
  shape.frequency = static_cast<float>(settings.frequency / settings.radius);
  shape.gain = static_cast<float>(settings.gain);
  shape.lacunarity = static_cast<float>(settings.lacunarity);
  shape.octaves = settings.octaves;
  shape.seed = settings.seed;
  return {shape, static_cast<int>(settings.edge), static_cast<float>(settings.voxel_size), 0};
}

void evaluate_cloud(const shared::CloudParams& params, std::span<const glm::ivec3> first_voxels,
                    std::span<float> values) {
  parallel_for(first_voxels.size(), 1, [&](std::size_t begin, std::size_t end) {
    for (std::size_t brick = begin; brick < end; ++brick)
      for (int voxel = 0; voxel < static_cast<int>(kBrickVoxels); ++voxel)
        values[brick * kBrickVoxels + static_cast<std::size_t>(voxel)] = shared::cloud_voxel(
            params, first_voxels[brick] + glm::ivec3(voxel & 7, voxel >> 3 & 7, voxel >> 6));
  });
}

Grid generate_cloud(const CloudSettings& settings, const CloudEvaluator& evaluate) {
  BRUME_ASSERT(settings.edge >= 1 && settings.edge <= kMaxCloudEdge, std::to_string(settings.edge));
  BRUME_ASSERT(settings.octaves <= kMaxCloudOctaves, std::to_string(settings.octaves));
  BRUME_ASSERT(settings.voxel_size > 0 && settings.radius > 0, std::to_string(settings.voxel_size));
  Grid grid;
  grid.name = "density";
  grid.grid_class = GridClass::fog_volume;
  grid.world_from_index = glm::dmat4(settings.voxel_size);
  const double first = -0.5 * (static_cast<double>(settings.edge) - 1) * settings.voxel_size;
  grid.world_from_index[3] = glm::dvec4(first, first, first, 1);

  const Shell shell = make_shell(settings);
  const int edge = static_cast<int>(settings.edge);
  Progress job("generate", (settings.edge + kBrickEdge - 1) / kBrickEdge);
  for (int z = 0; z < edge; z += kBrickEdge, job.advance()) append_layer(grid, settings, shell, z, evaluate);
  return grid;
}

}  // namespace brume::grids
