#include "smoke/sight_walls.hpp"

#include <algorithm>
#include <cmath>

#include "shared/dda.h"

namespace brume::smoke {
namespace {

using glm::ivec3;

ivec3 voxel_of(glm::dvec3 p_voxel) {
  // Far outside of any grid, but whole numbers.
  return ivec3(glm::floor(glm::clamp(p_voxel, glm::dvec3(-1e9), glm::dvec3(1e9))));
}

SightWall wall_at(const shared::Dda& d, ivec3 crossed, float metres_per_t) {
  SightWall wall{d.cell, ivec3(0), d.t * metres_per_t};
  for (int axis = 0; axis < 3; ++axis) {
    if (!crossed[axis]) continue;
    wall.normal[axis] = -d.stride[axis];
    break;
  }
  return wall;
}

}  // namespace

std::optional<SightWall> first_solid_between(const voxel::BitGrid& grid, glm::dvec3 a_world,
                                             glm::dvec3 b_world, bool b_hides) {
  const voxel::GridLayout& layout = grid.layout();
  const double size = layout.voxel_size;
  const glm::dvec3 a = (a_world - glm::dvec3(layout.origin_world)) / size;
  const glm::dvec3 b = (b_world - glm::dvec3(layout.origin_world)) / size;
  const glm::dvec3 line = b - a;
  const double length = std::sqrt(line.x * line.x + line.y * line.y + line.z * line.z);
  if (!(length > 0)) return std::nullopt;
  const ivec3 first = voxel_of(a), last = b_hides ? first : voxel_of(b);

  // Planes of bricks are planes of voxels and are crossed at the very same t: the two walks fit exactly.
  const glm::vec3 origin(a), direction(line / length);
  const ivec3 bricks = (grid.size() + (voxel::kBrickSize - 1)) / voxel::kBrickSize;
  shared::Dda outer =
      shared::dda_begin(origin, direction, ivec3(0), grid.size(), 1, 0, static_cast<float>(length));
  if (!(outer.t < outer.t_end)) return std::nullopt;
  const ivec3 entered = outer.crossed;
  outer = shared::dda_begin(origin, direction, ivec3(0), bricks, voxel::kBrickSize, outer.t, outer.t_end);
  outer.crossed = entered;

  // Brick by brick, and in those that hold anything voxel by voxel.
  for (; outer.t < outer.t_end; outer = shared::dda_step(outer)) {
    const voxel::BitGrid::Brick* brick = grid.find_brick(outer.cell);
    if (!brick) continue;
    const ivec3 low = outer.cell * voxel::kBrickSize;
    shared::Dda d = shared::dda_begin(origin, direction, low, glm::min(low + voxel::kBrickSize, grid.size()),
                                      1, outer.t, outer.t_end);
    ivec3 crossed = outer.crossed;  // of the first voxel: how the ray came into the brick
    while (d.t < d.t_end) {
      const ivec3 in = d.cell & 7;
      const bool solid = (*brick)[static_cast<unsigned>(in.z)] >> (in.x + 8 * in.y) & 1;
      if (solid && d.cell != first && d.cell != last) return wall_at(d, crossed, layout.voxel_size);
      d = shared::dda_step(d);
      crossed = d.crossed;
    }
  }
  return std::nullopt;
}

}  // namespace brume::smoke
