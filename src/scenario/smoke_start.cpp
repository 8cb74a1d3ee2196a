#include "scenario/smoke_start.hpp"

#include <algorithm>
#include <tuple>
#include <vector>

#include "scene/ray.hpp"

namespace brume::scenario {
namespace {

/// A surface that is nearer than this does not hide what is behind: the place lies on it [m].
constexpr float kOnSurface = 1e-3f;

/// A place in voxels, from the grid's corner.
glm::vec3 in_voxels(const voxel::GridLayout& layout, glm::vec3 world) {
  const glm::vec3 p = (world - layout.origin_world) / layout.voxel_size;
  return glm::clamp(p, glm::vec3(-1e9f), glm::vec3(1e9f));
}

float distance_to_voxel(glm::ivec3 voxel, glm::vec3 p) {
  return glm::distance(p, glm::clamp(p, glm::vec3(voxel), glm::vec3(voxel + 1)));
}

}  // namespace

glm::vec3 smoke_start(const Scenario& scenario, glm::vec3 place_world) {
  const voxel::BitGrid& grid = scenario.voxels.grid;
  const voxel::GridLayout& layout = grid.layout();
  const glm::vec3 p = in_voxels(layout, place_world);
  const glm::ivec3 own(glm::floor(p));
  if (!grid.solid(own)) return place_world;

  std::vector<glm::ivec3> beside;
  for_each_in(Box<int>{own - 1, own + 2}, [&](glm::ivec3 v) {
    if (grid.free(v)) beside.push_back(v);
  });
  std::ranges::stable_sort(
      beside, {}, [&](glm::ivec3 v) { return std::tuple(v.y < own.y, distance_to_voxel(v, p), -v.y); });
  for (const glm::ivec3 voxel : beside) {
    const glm::vec3 centre = layout.origin_world + (glm::vec3(voxel) + 0.5f) * layout.voxel_size;
    const glm::vec3 along = glm::normalize(centre - place_world);
    const glm::vec3 from = place_world + kOnSurface * along;
    const auto hit = scene::first_hit(scenario.scene, from, along);
    if (!hit || glm::distance(from, *hit) > glm::distance(from, centre)) return centre;
  }
  return place_world;
}

}  // namespace brume::scenario
