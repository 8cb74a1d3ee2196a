// Surface planes between the voxels: smoke ends at the wall, not at the voxel grid.
//
// A *cell* is the cube between eight neighbouring voxel centres: cell c spans [c + 0.5, c + 1.5) in voxel
// space and its corners are the voxels c .. c + 1: the domain of one trilinear interpolation. Where at least
// one corner is solid, up to three planes tell on which side of the surfaces a point of the cell lies.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "core/box.hpp"
#include "voxel/bit_grid.hpp"
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

/// The planes of all cells of a grid, border cells (cell -1 and cell size - 1 per axis) included.
///
/// The triangles are clipped to each cell; the pieces are clustered by unoriented direction, so that the two
/// faces of a thin wall become one plane in its middle, a piece of a round column one plane near its tangent,
/// and a corner of a room two or three planes. A plane's normal is the area-weighted mean of its pieces'
/// normals, and the plane passes through the mean of their centroids. The largest component of a normal (the
/// first of equal ones) is positive. A face exactly between two cells belongs to the upper one.
class SurfacePlanes {
 public:
  SurfacePlanes() = default;

  /// From the triangles that `grid` was voxelized from. The result does not depend on the number of threads.
  static SurfacePlanes build(std::span<const Triangle> triangles, const BitGrid& grid);

  /// The same for the cells of a box only; all others get no planes. `cleared`: boxes of voxels removed from
  /// the voxelization. In cells with a corner in one of them only those parts of the triangles count that lie
  /// in or at a voxel that is still solid.
  static SurfacePlanes build_in(std::span<const Triangle> triangles, const BitGrid& grid,
                                const Box<int>& cells, std::span<const Box<int>> cleared);

  /// The planes of a cell, at most kMaxPlanes, by decreasing area; none where no surface crosses the cell or
  /// the cell lies outside [-1, size - 1].
  std::span<const Plane> at(glm::ivec3 cell) const;

  std::size_t cell_count() const { return keys_.size(); }
  std::size_t plane_count() const { return planes_.size(); }
  /// Bytes of memory held.
  std::uint64_t bytes() const;

  /// Keys of the cells with planes, ascending: x + nx (y + ny z) of cell + 1 with n = size + 1.
  std::span<const std::uint64_t> keys() const { return keys_; }
  /// All planes, cell after cell in the order of keys().
  std::span<const Plane> planes() const { return planes_; }
  /// The number of planes of the i-th cell of keys().
  std::uint32_t count(std::size_t i) const { return first_[i + 1] - first_[i]; }

  /// Reassembles the output of keys(), count() and planes() for a grid of `size` voxels. The parts may come
  /// from a file: returns nothing when they are inconsistent or contain an invalid plane.
  static std::optional<SurfacePlanes> from_parts(glm::ivec3 size, std::vector<std::uint64_t> keys,
                                                 std::span<const std::uint8_t> counts,
                                                 std::vector<Plane> planes);

  bool operator==(const SurfacePlanes& other) const {
    return size_ == other.size_ && keys_ == other.keys_ && first_ == other.first_ && planes_ == other.planes_;
  }

 private:
  /// Which of 8^3 cells have planes, a bit each, and where they are: the i-th is keys_[order_[first + i]].
  struct Brick {
    std::uint64_t key = 0;
    std::array<std::uint64_t, 8> cells{};   // by z: x + 8 y
    std::array<std::uint16_t, 8> before{};  // cells of lower z
    std::uint32_t first = 0;
  };

  void build_index();
  void add_to_index(std::uint64_t brick_key);
  const Brick* find_brick(std::uint64_t brick_key) const;

  glm::ivec3 size_{0};
  std::vector<std::uint64_t> keys_;
  std::vector<std::uint32_t> first_;  // First plane of each key, and the total at the end.
  std::vector<Plane> planes_;
  std::vector<std::uint32_t> index_;  // Hash table of 2^k entries: number of the brick + 1, 0: none.
  std::vector<Brick> bricks_;
  std::vector<std::uint32_t> order_;
};

}  // namespace brume::voxel
