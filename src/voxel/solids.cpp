#include "voxel/solids.hpp"

#include <utility>

#include "voxel/voxelize.hpp"

namespace brume::voxel {

void TrianglesByRole::add(Role role, std::span<const Triangle> triangles) {
  // The walls are a list of their own from the first glass on.
  if (role == Role::glass && !walls) walls = smoke;
  if (stops_smoke(role)) smoke.insert(smoke.end(), triangles.begin(), triangles.end());
  if (stops_sight(role) && walls) walls->insert(walls->end(), triangles.begin(), triangles.end());
  if (role == Role::grille) grilles.insert(grilles.end(), triangles.begin(), triangles.end());
}

Result<RoleGrids> voxelize_roles(const TrianglesByRole& triangles, const BitGrid& grid) {
  RoleGrids roles;
  if (triangles.walls) {
    auto walls = voxelize(*triangles.walls, grid.layout());
    if (!walls) return walls.failure();
    roles.sight = std::move(*walls);
  }
  if (!triangles.grilles.empty()) {
    const auto grilles = voxelize(triangles.grilles, grid.layout());
    if (!grilles) return grilles.failure();
    roles.bodies = united(grid, *grilles);
  }
  return roles;
}

BitGrid united(const BitGrid& a, const BitGrid& b) {
  BitGrid both = a;
  b.for_each_brick([&](glm::ivec3 at, const BitGrid::Brick& brick) {
    BitGrid::Brick& target = both.ensure_brick(at);
    for (std::size_t z = 0; z < brick.size(); ++z) target[z] |= brick[z];
  });
  return both;
}

BitGrid without(const BitGrid& a, const BitGrid& b) {
  BitGrid rest(a.layout());
  a.for_each_brick([&](glm::ivec3 at, const BitGrid::Brick& brick) {
    BitGrid::Brick bits = brick;
    if (const BitGrid::Brick* other = b.find_brick(at))
      for (std::size_t z = 0; z < bits.size(); ++z) bits[z] &= ~(*other)[z];
    if (bits != BitGrid::Brick{}) rest.ensure_brick(at) = bits;
  });
  return rest;
}

}  // namespace brume::voxel
