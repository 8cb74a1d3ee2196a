// A level whose parts come and go: after each change only the voxels and planes that it touches are made
// anew.
//
//   layers, in the order in which they were put down:   part, part, part, box, part, ...
//   a part: a list of triangles, shown or hidden;  a box: voxels made solid, or free
//
// Showing a part again, or giving it other triangles, puts it down anew, on top. A box makes free what lies
// below it and nothing else.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "voxel/bit_grid.hpp"
#include "voxel/int_box.hpp"
#include "voxel/surface_planes.hpp"
#include "voxel/triangle.hpp"

namespace brume::voxel {

/// What a change did. Outside of `voxels` no voxel changed, and outside of `cells` no plane.
struct LevelChange {
  IntBox voxels, cells;
  BitGrid before;        ///< The voxels of `voxels` as they were; nothing else in it.
  SurfacePlanes planes;  ///< The planes of `cells` as they are now; nothing else in it.
};

class Level {
 public:
  /// A level of parts, all shown, numbered from 0. `grid` must be what voxelize makes of all their triangles.
  Level(BitGrid grid, std::vector<std::vector<Triangle>> parts);

  const BitGrid& grid() const { return grid_; }
  std::uint32_t part_count() const { return static_cast<std::uint32_t>(parts_.size()); }
  bool shown(std::uint32_t part) const { return parts_[part].shown; }

  /// Shows or hides parts. One that is as it should be already stays as it is.
  LevelChange show(std::span<const std::uint32_t> parts, bool shown);
  /// Gives a part other triangles: it has moved, or it is a new mesh in a part of add_part.
  LevelChange replace(std::uint32_t part, std::vector<Triangle> triangles);
  /// One more part, shown, without triangles. Returns its number.
  std::uint32_t add_part();
  /// Makes the voxels of a box solid, with surfaces along its six faces, or free.
  LevelChange set_box(IntBox box, bool solid);

  /// The planes of a stretch of cells as they are now.
  SurfacePlanes planes_in(const IntBox& cells) const;
  /// Bytes of memory held.
  std::uint64_t bytes() const;

 private:
  // Triangles that follow each other in a mesh are near each other: what lies elsewhere is left out run by
  // run.
  struct Run {
    glm::vec3 low, high;
  };
  struct Part {
    std::vector<Triangle> triangles;
    std::vector<Run> runs;
    Run bounds;
    bool shown = true;
    std::uint64_t layer = 0;
  };
  struct Box {
    IntBox voxels;
    bool solid;
    std::uint64_t layer;
  };
  // World space [m]; what is outside cannot matter.
  struct Reach {
    glm::dvec3 low, high;
    bool misses(const Run& run) const;
  };

  static Part make_part(std::vector<Triangle> triangles);
  Reach reach_of(const glm::dvec3& low_voxel, const glm::dvec3& high_voxel) const;
  IntBox voxels_of(const Part& part) const;
  void gather(const Part& part, const Reach& reach, std::vector<Triangle>& out) const;
  LevelChange rebuild(const IntBox& voxels);
  void paint(const IntBox& voxels);
  void add_faces(const Box& box, std::vector<Triangle>& out) const;

  BitGrid grid_;
  std::vector<Part> parts_;
  std::vector<Box> boxes_;
  std::uint64_t last_layer_ = 0;
};

}  // namespace brume::voxel
