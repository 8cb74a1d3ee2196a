#include "python/density.hpp"

#include <cmath>
#include <cstring>

#include "scenario/smoke_grid.hpp"

namespace brume::python {
namespace {

/// Writes the voxels of a brick that lie in the box; all others of the array are 0.
template <typename T>
void fill_densities(const grids::Brick& brick, const float* values, const Box<int>& box, T* out) {
  const auto [low, high] = intersection(box, {brick.origin, brick.origin + grids::kBrickEdge});
  const glm::ivec3 size = box.high - box.low;
  for_each_in(Box<int>{low, high}, [&](glm::ivec3 v) {
    const glm::ivec3 local = v - brick.origin, at = v - box.low;
    const float value = values[local.x + 8 * (local.y + 8 * local.z)];
    T& texel = out[(std::size_t(at.x) * std::size_t(size.y) + std::size_t(at.y)) * std::size_t(size.z) +
                   std::size_t(at.z)];
    if constexpr (std::is_same_v<T, float>)
      texel = value;
    else
      texel = static_cast<T>(std::lround(255 * value));
  });
}

template <typename T>
py::array filled(const grids::Grid& grid, const Box<int>& box) {
  const glm::ivec3 size = box.high - box.low;
  py::array_t<T> result({size.x, size.y, size.z});
  T* const out = result.mutable_data();
  released([&] {
    std::memset(out, 0, static_cast<std::size_t>(result.nbytes()));
    std::array<float, grids::kBrickVoxels> values;
    for (std::size_t i = 0; i < grid.bricks.size(); ++i) {
      std::memcpy(values.data(), grid.values_of(i).data(), sizeof values);
      fill_densities(grid.bricks[i], values.data(), box, out);
    }
  });
  return result;
}

}  // namespace

py::array density_array(const Smoke& smoke, const py::object& low, const py::object& high, bool as_steps) {
  const Box<int> box = voxel_box(smoke.level().grid().layout(), low, high);
  const grids::Grid grid =
      smoke.read([](const sim::World& world) { return scenario::smoke_grid(world.state(), {}); });
  return as_steps ? filled<std::uint8_t>(grid, box) : filled<float>(grid, box);
}

}  // namespace brume::python
