#include "voxel/traverse.hpp"

namespace brume::voxel {
namespace {

using glm::ivec3;

RayHit hit_of(const shared::Dda& d, float t, ivec3 crossed) {
  RayHit hit{d.cell, t, ivec3(0)};
  for (int axis = 0; axis < 3; ++axis) {
    if (!crossed[axis]) continue;
    hit.normal[axis] = -d.stride[axis];
    break;
  }
  return hit;
}

// The first solid voxel on the ray segment within a brick.
std::optional<RayHit> first_in_brick(const BitGrid::Brick& bits, const shared::Dda& outer, ivec3 size,
                                     glm::vec3 origin, glm::vec3 direction) {
  const ivec3 low = outer.cell * kBrickSize, high = glm::min(low + kBrickSize, size);
  shared::Dda d = shared::dda_begin(origin, direction, low, high, 1, outer.t, outer.t_end);
  ivec3 crossed = outer.crossed;  // The first voxel is entered through the face of the brick.
  while (d.t < d.t_end) {
    if (bits[static_cast<unsigned>(d.cell.z & 7)] >> ((d.cell.x & 7) + 8 * (d.cell.y & 7)) & 1)
      return hit_of(d, d.t, crossed);
    d = shared::dda_step(d);
    crossed = d.crossed;
  }
  return std::nullopt;
}

}  // namespace

std::optional<RayHit> first_solid(const BitGrid& grid, glm::vec3 origin_voxel, glm::vec3 direction,
                                  float t_max) {
  if (!is_ray(origin_voxel, direction)) return std::nullopt;
  // Brick faces are voxel faces and are crossed at exactly the same t: both traversals agree.
  const ivec3 size = grid.size(), bricks = (size + (kBrickSize - 1)) / kBrickSize;
  shared::Dda d = shared::dda_begin(origin_voxel, direction, ivec3(0), size, 1, 0, t_max);
  const float t_end = d.t_end;
  if (!(d.t < t_end)) return std::nullopt;
  const ivec3 crossed = d.crossed;
  d = shared::dda_begin(origin_voxel, direction, ivec3(0), bricks, kBrickSize, d.t, t_end);
  d.crossed = crossed;
  while (d.t < d.t_end) {
    if (const BitGrid::Brick* bits = grid.find_brick(d.cell)) {
      if (auto hit = first_in_brick(*bits, d, size, origin_voxel, direction)) return hit;
    }
    d = shared::dda_step(d);
  }
  return std::nullopt;
}

}  // namespace brume::voxel
