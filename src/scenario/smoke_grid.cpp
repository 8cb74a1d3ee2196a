#include "scenario/smoke_grid.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "core/box.hpp"
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

/// An empty grid of a tick.
grids::Grid grid_of(const sim::State& state, const voxel::GridLayout& layout,
                    const SmokeGridOptions& options) {
  grids::Grid grid;
  grid.name = "density";
  grid.grid_class = grids::GridClass::fog_volume;
  grid.world_from_index = world_from_index(layout, options.up);
  grid.metadata = {metadata("extinction", "float", options.extinction),
                   metadata("tick", "int32", static_cast<std::int32_t>(state.tick)),
                   metadata("time", "double", static_cast<double>(state.tick) / state.ticks_per_second)};
  return grid;
}

/// Adds the bricks at these places, make(origin, values) of each, but for those without smoke. In parallel.
template <typename Make>
void add_bricks(grids::Grid& grid, const std::vector<glm::ivec3>& origins, const Make& make) {
  std::vector<grids::Brick> bricks(origins.size());
  std::vector<float> values(origins.size() * grids::kBrickVoxels);
  parallel_for(origins.size(), 16, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i)
      bricks[i] = make(origins[i], values.data() + i * grids::kBrickVoxels);
  });
  for (std::size_t i = 0; i < bricks.size(); ++i) {
    if (bricks[i].active == std::array<std::uint64_t, 8>{}) continue;
    grid.bricks.push_back(bricks[i]);
    const auto bytes = std::as_bytes(std::span(values).subspan(i * grids::kBrickVoxels, grids::kBrickVoxels));
    grid.values.insert(grid.values.end(), bytes.begin(), bytes.end());
  }
}

/// The bricks of a layout that touch the smoke's, in the order of a grid.
std::vector<glm::ivec3> brick_origins(const smoke::SmokeVolume& volume, const voxel::GridLayout& layout) {
  // From the level's corner, in voxels of the layout.
  const double edge = 8 * double{volume.layout().voxel_size} / double{layout.voxel_size};
  std::vector<glm::ivec3> origins;
  for (std::uint32_t slot = 0; slot < volume.slot_count(); ++slot) {
    if (!volume.in_use(slot)) continue;
    const glm::dvec3 low = edge * glm::dvec3(volume.brick_of(slot));
    const glm::ivec3 first(glm::floor(low / 8.0)), end(glm::ceil((low + edge) / 8.0));
    for_each_in(Box<int>{first, end}, [&](glm::ivec3 brick) { origins.push_back(8 * brick); });
  }
  std::sort(origins.begin(), origins.end(), grids::goes_before);
  origins.erase(std::unique(origins.begin(), origins.end()), origins.end());
  return origins;
}

}  // namespace

grids::Grid smoke_grid(const sim::State& state, const SmokeGridOptions& options) {
  grids::Grid grid = grid_of(state, state.layout, options);
  add_bricks(grid, brick_origins(state),
             [&](glm::ivec3 origin, float* values) { return make_brick(state, origin, values); });
  return grid;
}

Result<grids::Grid> drawn_smoke_grid(const smoke::DrawnSmoke& smoke, float voxel_size,
                                     const SmokeGridOptions& options) {
  const smoke::SmokeVolume& volume = *smoke.input().volume;
  const sim::State& state = *smoke.input().state;
  voxel::GridLayout layout = state.layout;
  layout.voxel_size = voxel_size;

  // Bricks that the smoke's touch are at most so many, before they are listed.
  const double across = std::ceil(double{volume.layout().voxel_size} / double{voxel_size}) + 1;
  if (volume.slot_count() * across * across * across * grids::kBrickVoxels > double{kMostDrawnVoxels})
    return Failure{ErrorCode::resource_limit, "smoke in voxels of this size may need more than " +
                                                  std::to_string(kMostDrawnVoxels) +
                                                  " voxels; choose larger ones"};
  grids::Grid grid = grid_of(state, layout, options);
  add_bricks(grid, brick_origins(volume, layout), [&](glm::ivec3 origin, float* values) {
    grids::Brick brick{origin, {}};
    for (std::size_t i = 0; i < grids::kBrickVoxels; ++i) {
      const glm::ivec3 local(static_cast<int>(i % 8), static_cast<int>(i / 8 % 8), static_cast<int>(i / 64));
      const glm::vec3 centre = layout.origin_world + voxel_size * (glm::vec3(origin + local) + 0.5f);
      values[i] = smoke.density(centre);
      if (values[i] > 0) brick.active[i / 64] |= std::uint64_t{1} << (i % 64);
    }
    return brick;
  });
  return grid;
}

}  // namespace brume::scenario
