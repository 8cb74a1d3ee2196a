// A level whose parts can be shown, hidden and moved: each change rebuilds only the voxels and planes that it
// touches.
//
//   layers, from bottom to top:   part, part, part, box, part, ...
//   a part: a list of triangles of one role, shown or hidden;  a box: voxels made wall, or free of all
//
// Showing a part again, or replacing its triangles, moves it to the top. A box affects only the layers below
// it.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/box.hpp"
#include "voxel/bit_grid.hpp"
#include "voxel/solids.hpp"
#include "voxel/surface_planes.hpp"
#include "voxel/triangle.hpp"

namespace brume::voxel {

/// The effect of a change. No voxel outside of `voxels` and no plane outside of `cells` has changed.
struct LevelChange {
  Box<int> voxels, cells;
  BitGrid before;               ///< The content of `voxels` before the change; free elsewhere.
  SurfacePlanes planes;         ///< The planes of `cells` after the change; none elsewhere.
  RoleGrids roles_before = {};  ///< The roles in `voxels`, as `before`.
};

/// What a level is made of.
struct LevelPart {
  std::vector<Triangle> triangles;
  Role role = Role::wall;
};

class Level {
 public:
  /// A level of parts, all shown, numbered from 0. `grid` must be the voxelization of all their triangles.
  Level(BitGrid grid, std::vector<std::vector<Triangle>> parts);
  /// The same of parts with roles. `grid` holds the voxels that stop smoke, `roles` the grids of all roles.
  Level(BitGrid grid, RoleGrids roles, std::vector<LevelPart> parts);

  /// What stops smoke.
  const BitGrid& grid() const { return grid_; }
  Solids solids() const { return {grid_, roles_}; }
  std::uint32_t part_count() const { return static_cast<std::uint32_t>(parts_.size()); }
  bool shown(std::uint32_t part) const { return parts_[part].shown; }

  /// Shows or hides parts; no effect on those already in that state.
  LevelChange show(std::span<const std::uint32_t> parts, bool shown);
  /// Replaces the triangles of a part, which keeps its role: it has moved, or it is a new part from add_part.
  LevelChange replace(std::uint32_t part, std::vector<Triangle> triangles);
  /// Adds a wall, shown, without triangles. Returns its number.
  std::uint32_t add_part();
  /// Makes the voxels of a box wall, with surfaces along its six faces, or free of all roles.
  LevelChange set_box(Box<int> box, bool solid);

  /// The current planes of a box of cells.
  SurfacePlanes planes_in(const Box<int>& cells) const;
  /// Bytes of memory held.
  std::uint64_t bytes() const;

 private:
  // Consecutive triangles of a mesh lie close together: culling works on runs of them.
  struct Run {
    glm::vec3 low, high;
  };
  struct Part {
    std::vector<Triangle> triangles;
    std::vector<Run> runs;
    Run bounds;
    Role role = Role::wall;
    bool shown = true;
    std::uint64_t layer = 0;
  };
  struct EditedBox {
    Box<int> voxels;
    bool solid;
    std::uint64_t layer;
  };
  // World space [m]; triangles outside have no effect.
  struct Reach {
    glm::dvec3 low, high;
    bool misses(const Run& run) const;
  };

  static Part make_part(std::vector<Triangle> triangles, Role role);
  Reach reach_of(const glm::dvec3& low_voxel, const glm::dvec3& high_voxel) const;
  Box<int> voxels_of(const Part& part) const;
  void gather(const Part& part, const Reach& reach, std::vector<Triangle>& out) const;
  LevelChange rebuild(const Box<int>& voxels);
  void paint(const Box<int>& voxels);
  void fill_boxes(const Box<int>& voxels, bool solid);
  void draw_part(Role role, std::span<const Triangle> triangles, const Box<int>& voxels);
  void add_faces(const EditedBox& box, std::vector<Triangle>& out) const;

  BitGrid grid_;
  RoleGrids roles_;
  std::vector<Part> parts_;
  std::vector<EditedBox> boxes_;
  std::uint64_t last_layer_ = 0;
};

}  // namespace brume::voxel
