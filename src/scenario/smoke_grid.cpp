#include "scenario/smoke_grid.hpp"

#include <algorithm>
#include <cstring>

#include "core/tasks.hpp"

namespace brume::scenario {
namespace {

template <typename T>
grids::Metadata metadata(const char* name, const char* type, T value) {
  grids::Metadata entry{name, type, std::vector<std::byte>(sizeof value)};
  std::memcpy(entry.bytes.data(), &value, sizeof value);
  return entry;
}

glm::dmat4 world_from_index(const voxel::GridLayout& layout, UpAxis up) {
  // A voxel's centre is its index in the grid, and half a voxel further in the simulation.
  const double size{layout.voxel_size};
  glm::dmat4 matrix(size);
  matrix[3] = glm::dvec4(glm::dvec3(layout.origin_world) + 0.5 * size, 1);
  if (up == UpAxis::y) return matrix;
  for (int i = 0; i < 4; ++i) matrix[i] = glm::dvec4(matrix[i].x, 0 - matrix[i].z, matrix[i].y, matrix[i].w);
  return matrix;
}

// The bricks in which a cloud may have smoke, in the order of a grid.
std::vector<glm::ivec3> brick_origins(const sim::State& state) {
  std::vector<glm::ivec3> origins;
  for (const sim::LiveCloud& live : state.clouds)
    for (const sim::VoxelBlock& block : live.cloud->voxels().blocks())
      origins.push_back(glm::ivec3(block.at) * sim::kBlockSize & ~(grids::kBrickEdge - 1));
  std::sort(origins.begin(), origins.end(), grids::goes_before);
  origins.erase(std::unique(origins.begin(), origins.end()), origins.end());
  return origins;
}

// Densities of a brick's voxels into `values`, zeros in advance.
grids::Brick make_brick(const sim::State& state, glm::ivec3 origin, float* values) {
  grids::Brick brick{origin, {}};
  for (std::size_t i = 0; i < grids::kBrickVoxels; ++i) {
    const glm::ivec3 local(static_cast<int>(i % 8), static_cast<int>(i / 8 % 8), static_cast<int>(i / 64));
    const std::uint8_t density = state.density(origin + local);
    if (density == 0) continue;
    brick.active[i / 64] |= std::uint64_t{1} << (i % 64);
    values[i] = static_cast<float>(density) / 255;
  }
  return brick;
}

}  // namespace

grids::Grid smoke_grid(const sim::State& state, const SmokeGridOptions& options) {
  // What describes the grid.
  grids::Grid grid;
  grid.name = "density";
  grid.grid_class = grids::GridClass::fog_volume;
  grid.world_from_index = world_from_index(state.layout, options.up);
  grid.metadata = {metadata("extinction", "float", options.extinction),
                   metadata("tick", "int32", static_cast<std::int32_t>(state.tick)),
                   metadata("time", "double", static_cast<double>(state.tick) / state.ticks_per_second)};

  // All bricks, in parallel.
  const std::vector<glm::ivec3> origins = brick_origins(state);
  std::vector<grids::Brick> bricks(origins.size());
  std::vector<float> values(origins.size() * grids::kBrickVoxels);
  parallel_for(origins.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      bricks[i] = make_brick(state, origins[i], values.data() + i * grids::kBrickVoxels);
  });

  // Those with smoke at this tick.
  for (std::size_t i = 0; i < bricks.size(); ++i) {
    if (bricks[i].active == std::array<std::uint64_t, 8>{}) continue;
    grid.bricks.push_back(bricks[i]);
    const auto bytes = std::as_bytes(std::span(values).subspan(i * grids::kBrickVoxels, grids::kBrickVoxels));
    grid.values.insert(grid.values.end(), bytes.begin(), bytes.end());
  }
  return grid;
}

}  // namespace brume::scenario
