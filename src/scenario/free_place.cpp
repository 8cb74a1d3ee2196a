#include "scenario/free_place.hpp"

#include <algorithm>
#include <vector>

#include "core/box.hpp"
#include "sim/fill.hpp"

namespace brume::scenario {
namespace {

constexpr int kSearchVoxels = 48;
/// Floods to find out whether a place works.
constexpr int kMostFloods = 24;

/// The free voxels of a cube's surface around `middle`, nearest first.
std::vector<glm::ivec3> free_shell(const voxel::BitGrid& grid, glm::ivec3 middle, int radius) {
  std::vector<glm::ivec3> shell;
  const Box<int> box{middle - radius, middle + radius + 1};
  const auto add = [&](glm::ivec3 v) {
    if (grid.free(v)) shell.push_back(v);
  };
  for_each_in(Box<int>{{0, box.low.y, box.low.z}, {1, box.high.y, box.high.z}}, [&](glm::ivec3 v) {
    const bool inner = v.y > box.low.y && v.y < box.high.y - 1 && v.z > box.low.z && v.z < box.high.z - 1;
    if (inner) {
      add({box.low.x, v.y, v.z});
      if (radius > 0) add({box.high.x - 1, v.y, v.z});
      return;
    }
    for (int x = box.low.x; x < box.high.x; ++x) add({x, v.y, v.z});
  });
  const auto distance = [&](glm::ivec3 v) {
    const glm::ivec3 off = v - middle;
    return off.x * off.x + off.y * off.y + off.z * off.z;
  };
  std::ranges::stable_sort(shell, {}, distance);
  return shell;
}

bool is_above_solid(const voxel::BitGrid& grid, glm::ivec3 voxel) {
  for (int y = voxel.y - 1; y >= 0; --y)
    if (grid.solid({voxel.x, y, voxel.z})) return true;
  return false;
}

}  // namespace

glm::ivec3 voxel_of(const voxel::GridLayout& layout, glm::vec3 at_world) {
  const glm::vec3 p = (at_world - layout.origin_world) / layout.voxel_size;
  return glm::ivec3(glm::floor(glm::clamp(p, glm::vec3(-1e9f), glm::vec3(1e9f))));
}

glm::vec3 centre_of(const voxel::GridLayout& layout, glm::ivec3 voxel) {
  return layout.origin_world + (glm::vec3(voxel) + 0.5f) * layout.voxel_size;
}

std::optional<glm::vec3> nearest_free_place(const voxel::BitGrid& grid, glm::vec3 at_world,
                                            std::uint32_t voxels) {
  const voxel::GridLayout& layout = grid.layout();
  const glm::ivec3 middle = glm::clamp(voxel_of(layout, at_world), glm::ivec3(0), layout.size - 1);
  std::optional<glm::vec3> without_floor;
  int floods = 0;
  for (int radius = 0; radius <= kSearchVoxels && floods < kMostFloods; ++radius) {
    // One place per shell: its neighbours would mostly flood the same space. Under the lowest floor nobody
    // sees it.
    const std::vector<glm::ivec3> shell = free_shell(grid, middle, radius);
    // A way down counts three times: who names a place in the floor means the room above it.
    auto place = std::ranges::find_if(
        shell, [&](glm::ivec3 v) { return v.y >= middle.y - radius / 3 && is_above_solid(grid, v); });
    const bool has_floor = place != shell.end();
    if (!has_floor) place = shell.begin();
    if (place == shell.end() || (!has_floor && without_floor)) continue;
    ++floods;
    if (sim::flood_fill(grid, *place, voxels).size() < voxels) continue;
    if (has_floor) return centre_of(layout, *place);
    without_floor = centre_of(layout, *place);
  }
  return without_floor;
}

}  // namespace brume::scenario
