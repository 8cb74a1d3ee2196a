// What each voxel of a level stops. Without other roles than wall, one grid holds for everything.
//
//   stops sight  <=  stops smoke and shots  <=  stops bodies and thrown grenades     (as sets of voxels)
//      walls            walls, glass                 walls, glass, grilles
//
// A voxel that surfaces of several roles touch has the one that stops most.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "core/role.hpp"
#include "voxel/bit_grid.hpp"
#include "voxel/triangle.hpp"

namespace brume::voxel {

/// The grids of a level beside the grid of what stops smoke, where they differ from it.
struct RoleGrids {
  std::optional<BitGrid> sight;   ///< What stops sight; none: what stops smoke.
  std::optional<BitGrid> bodies;  ///< What stops bodies; none: what stops smoke.
  bool empty() const { return !sight && !bodies; }
  /// Bytes of memory held.
  std::uint64_t bytes() const { return (sight ? sight->bytes() : 0) + (bodies ? bodies->bytes() : 0); }
};

/// All grids of a level: references, of one layout.
struct Solids {
  /// All that is solid is wall. Implicit: most levels have no other role.
  Solids(const BitGrid& walls) : smoke(walls), sight(walls), bodies(walls) {}
  Solids(const BitGrid& of_smoke, const RoleGrids& roles)
      : smoke(of_smoke),
        sight(roles.sight ? *roles.sight : of_smoke),
        bodies(roles.bodies ? *roles.bodies : of_smoke) {}

  /// What stops most in the voxel; ghost where it is free or outside of the grid.
  Role role(glm::ivec3 v) const {
    if (sight.solid(v)) return Role::wall;
    if (smoke.solid(v)) return Role::glass;
    return bodies.solid(v) ? Role::grille : Role::ghost;
  }

  const BitGrid &smoke, &sight, &bodies;
};

/// The triangles of a level by what they stop.
struct TrianglesByRole {
  std::vector<Triangle> smoke;                 ///< Walls and glass, in the order of the level.
  std::optional<std::vector<Triangle>> walls;  ///< Without the glass; none: there is no glass.
  std::vector<Triangle> grilles;

  void add(Role role, std::span<const Triangle> triangles);
};

/// The other grids of a level whose `grid` is the voxelization of `triangles.smoke`. Fails as voxelize does.
Result<RoleGrids> voxelize_roles(const TrianglesByRole& triangles, const BitGrid& grid);

/// The voxels of both grids, which have one layout.
BitGrid united(const BitGrid& a, const BitGrid& b);
/// The voxels of `a` that are not in `b`, of the same layout.
BitGrid without(const BitGrid& a, const BitGrid& b);

}  // namespace brume::voxel
