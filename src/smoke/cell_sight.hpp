// The 4x4x4 voxels around a cell, and which of them are visible from a point of the cell past surfaces.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "shared/smoke_volume.h"
#include "voxel/surface_planes.hpp"

namespace brume::smoke {

/// The planes of a cell, at most voxel::kMaxPlanes; empty where it has none.
using PlaneSource = std::function<std::span<const voxel::Plane>(glm::ivec3 cell)>;

/// Voxels cell - 1 to cell + 2 per axis as bits x + 4 y + 16 z: all that the cell's corners may take from.
using Neighbourhood64 = std::uint64_t;

constexpr Neighbourhood64 neighbour_bit(glm::ivec3 v) {
  return Neighbourhood64{1} << (v.x + 4 * v.y + 16 * v.z);
}
inline glm::ivec3 neighbour_offset(int bit) {
  return {bit & 3, bit >> 2 & 3, bit >> 4};
}
inline glm::ivec3 corner_offset(int corner) {
  return {corner & 1, corner >> 1 & 1, corner >> 2};
}
/// The centre of a neighbourhood's voxel from the centre of its cell [voxels].
inline glm::vec3 from_cell_centre(int bit) {
  return glm::vec3(neighbour_offset(bit)) - 1.5f;
}

/// The planes of 8^3 cells and of those around them, each queried once.
class PlaneWindow {
 public:
  explicit PlaneWindow(const PlaneSource& source) : source_(source) {}
  /// To other cells, or because planes changed.
  void move_to(glm::ivec3 lowest_cell) {
    first_cell_ = lowest_cell - 1;
    known_.fill(false);
  }
  /// The planes of one of the cells or of a cell next to one.
  std::span<const voxel::Plane> at(glm::ivec3 cell) {
    const glm::ivec3 c = cell - first_cell_;
    const auto i = static_cast<std::size_t>(c.x + 10 * (c.y + 10 * c.z));
    if (!known_[i]) {
      planes_[i] = source_(cell);
      known_[i] = true;
    }
    return planes_[i];
  }

 private:
  const PlaneSource& source_;
  glm::ivec3 first_cell_{0};
  std::array<bool, 1000> known_{};
  std::array<std::span<const voxel::Plane>, 1000> planes_;
};

/// Visibility around one cell at a time. Surfaces are the planes of `planes`, each a square that ends at the
/// faces of its cell.
class CellSight {
 public:
  explicit CellSight(PlaneWindow& planes) : planes_(planes) {}

  /// Sets the cell: reads its planes and the planes of the 26 cells around it.
  void look_at(glm::ivec3 cell);
  /// The planes of the cell, packed as the shader reads them; first_set is 0.
  const shared::BoundaryCell& record() const { return record_; }
  int plane_count() const { return plane_count_; }
  /// 2^planes.
  int side_count() const { return 1 << plane_count_; }
  /// How far the surface may lie off plane `k` of the cell [voxels]; 0 where it continues flat.
  float deviation(int k) const { return deviation_[static_cast<std::size_t>(k)]; }
  /// Plane `k`, packed, moved by `distance` along its normal [voxels].
  std::uint32_t moved_plane(int k, float distance) const;

  /// The voxels of `among` on side `side` of the cell's planes, taken as infinite.
  Neighbourhood64 on_side(int side, Neighbourhood64 among) const;
  /// The voxels of `among` that are visible from the points of the cell on side `side`.
  Neighbourhood64 visible(int side, Neighbourhood64 among);

 private:
  /// One plane in one or several of the 3x3x3 cells around; relative to the centre of the cell.
  struct Sheet {
    glm::vec3 normal;
    float offset;
    std::uint32_t cells;             // bit x + 3 y + 9 z of cell + 1
    std::uint32_t open_cells;        // others that the infinite plane enters
    Neighbourhood64 positive;        // voxels on the positive side
    std::array<float, 64> distance;  // from the plane to each voxel
  };
  void read_own_planes(std::span<const voxel::Plane> own);
  void read_neighbour(const voxel::Plane& plane, glm::ivec3 step);
  void add_sheet(const voxel::Plane& plane, glm::ivec3 step);
  void measure_voxels();
  Neighbourhood64 visible_from(glm::vec3 viewpoint, const std::array<Neighbourhood64, 27>& paths,
                               Neighbourhood64 among) const;
  Neighbourhood64 possibly_visible(std::uint32_t samples, Neighbourhood64 among) const;
  void find_viewpoints();

  PlaneWindow& planes_;
  shared::BoundaryCell record_{};
  int plane_count_ = 0;
  std::array<voxel::Plane, voxel::kMaxPlanes> own_;
  std::array<Neighbourhood64, voxel::kMaxPlanes>
      positive_;  // voxels on the positive side of the packed planes
  std::array<float, voxel::kMaxPlanes> deviation_;
  bool flat_ = true;  // every plane around continues one of the cell's own
  std::vector<Sheet> sheets_;
  // Points spread over each side, one bit each, and their middle.
  std::array<std::uint32_t, 8> samples_{};
  std::array<glm::vec3, 8> middles_;
};

}  // namespace brume::smoke
