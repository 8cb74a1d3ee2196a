// Where the surfaces run between the voxels, so that smoke can end at the wall and not at the grid.
//
// A *cell* is the cube between eight neighbouring voxel centres: cell c spans [c + 0.5, c + 1.5) in voxel
// space and its corners are the voxels c .. c + 1. This is the domain of one trilinear interpolation. Where
// at least one corner is solid, up to three planes say on which sides of which surfaces a point of the cell
// lies.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "voxel/bit_grid.hpp"
#include "voxel/int_box.hpp"
#include "voxel/triangle.hpp"

namespace brume::voxel {

constexpr int kMaxPlanes = 3;

/// A plane through a cell. A point is on its positive side when
/// dot(normal, position_voxel - cell_centre) > offset, with cell_centre = cell + 1.
struct Plane {
  glm::vec3 normal{0};  ///< Unit length, voxel space.
  float offset = 0;     ///< [voxels], within [-1, 1].
  bool operator==(const Plane&) const = default;
};

/// The planes of all cells of a grid, those of the border (cell -1 and cell size - 1 per axis) included.
///
/// In each cell the triangles are clipped to the cell; the pieces are put together by direction, whichever
/// way they face, so that the two faces of a thin wall become one plane in its middle, a piece of a round
/// column one plane near its tangent, and a corner of a room two or three planes. A plane's normal is the
/// mean of its pieces' normals weighted by area, and it goes through the mean of their centroids. The largest
/// component of a normal is positive (the first of equal ones). A face exactly between two cells is in the
/// upper one.
class SurfacePlanes {
 public:
  SurfacePlanes() = default;

  /// Of the triangles that `grid` was voxelized from. The same planes whatever the number of threads.
  static SurfacePlanes build(std::span<const Triangle> triangles, const BitGrid& grid);

  /// The same for the cells of a box alone, the others have no planes here. `cleared` are boxes of voxels
  /// that were taken out of the triangles' own: in the cells that have a corner in one of them, only the
  /// parts of the triangles count that lie in or at a voxel that is solid now.
  static SurfacePlanes build_in(std::span<const Triangle> triangles, const BitGrid& grid, const IntBox& cells,
                                std::span<const IntBox> cleared);

  /// The planes of a cell, the one with the largest area first: none where no surface runs through the cell,
  /// or the cell lies outside [-1, size - 1], at most kMaxPlanes.
  std::span<const Plane> at(glm::ivec3 cell) const;

  std::size_t cell_count() const { return keys_.size(); }
  std::size_t plane_count() const { return planes_.size(); }
  /// Bytes of memory held.
  std::uint64_t bytes() const;

  /// Cells that have planes, as numbers x + nx (y + ny z) of cell + 1 with n = size + 1, ascending.
  std::span<const std::uint64_t> keys() const { return keys_; }
  /// All planes, cell after cell in the order of keys().
  std::span<const Plane> planes() const { return planes_; }
  /// The number of planes of the i-th cell of keys().
  std::uint32_t count(std::size_t i) const { return first_[i + 1] - first_[i]; }

  /// Puts together what keys(), count() and planes() gave, for a grid of `size` voxels. Nothing when the
  /// parts contradict each other or a plane is not one: they may come from a file.
  static std::optional<SurfacePlanes> from_parts(glm::ivec3 size, std::vector<std::uint64_t> keys,
                                                 std::span<const std::uint8_t> counts,
                                                 std::vector<Plane> planes);

  bool operator==(const SurfacePlanes& other) const {
    return size_ == other.size_ && keys_ == other.keys_ && first_ == other.first_ && planes_ == other.planes_;
  }

 private:
  void build_index();

  glm::ivec3 size_{0};
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> first_;  // Of each key its first plane; one more at the end.
  std::vector<Plane> planes_;
  std::vector<std::uint32_t> index_;  // Hash table of 2^k entries: number of the key + 1, 0: none.
};

}  // namespace brume::voxel
