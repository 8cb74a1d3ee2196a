// The integral of smoke along a segment by definition, in double precision: many small steps, no cell
// traversal.
#pragma once

#include <cmath>
#include <span>

#include "smoke/sight.hpp"

namespace brume::reference {

/// Density [0, 1] at a point by the rule of docs/how/smoke.md: trilinear, and by the side of the planes in
/// every cell that has them.
inline double smoke_density(const smoke::SmokeVolume& volume, glm::dvec3 p_voxel) {
  const glm::ivec3 brick(glm::floor(p_voxel / 8.0));
  const std::uint32_t slot = volume.slot_at(brick);
  if (slot == smoke::SmokeVolume::kNoSlot) return 0;
  const glm::ivec3 cell(glm::floor(p_voxel - 0.5)), local = cell - 8 * brick + 1;
  const glm::dvec3 f = p_voxel - 0.5 - glm::dvec3(cell);
  const std::uint32_t entry =
      volume.cells(slot)[static_cast<std::size_t>(local.x + 9 * (local.y + 9 * local.z))];
  glm::uvec2 set(0);
  if (entry != 0) {
    const shared::BoundaryCell& boundary = volume.boundary_cells()[entry - 1];
    std::uint32_t side = 0, bit = 1;
    for (const std::uint32_t plane : {boundary.plane0, boundary.plane1, boundary.plane2}) {
      if (plane != 0 &&
          glm::dot(glm::dvec3(shared::plane_normal(plane)), f - 0.5) > double{shared::plane_offset(plane)})
        side |= bit;
      bit *= 2;
    }
    set = volume.corner_sets()[boundary.first_set + side];
  }
  double density = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 at(corner & 1, corner >> 1 & 1, corner >> 2), t = local + at;
    const double value =
        entry != 0 ? (set[corner >> 2] >> (8 * (corner & 3))) & 255u
                   : volume.texels(slot)[static_cast<std::size_t>(t.x + 10 * (t.y + 10 * t.z))].density;
    density += value / 255 * (at.x ? f.x : 1 - f.x) * (at.y ? f.y : 1 - f.y) * (at.z ? f.z : 1 - f.z);
  }
  return density;
}

struct SmokeIntegral {
  double plain = 0;  ///< Without holes [voxels].
  double holed = 0;
  /// Bound of the error of both: each step is off by at most its length times what the density varies in it.
  double error = 0;
};

/// Density by `density(p_voxel)`, in steps of `step` voxels; `masks` for mask holes.
template <typename Density>
SmokeIntegral integrate_smoke(const shared::VolumeLayout& frame, std::span<const shared::Hole> holes,
                              float time, const smoke::Segment& s, double step, const Density& density,
                              const smoke::MaskAtlas& masks = {}) {
  const glm::dvec3 a(s.a_world), way = glm::dvec3(s.b_world) - a;
  const double length = glm::length(way) / frame.voxel_size;
  const auto count = static_cast<std::int64_t>(std::ceil(length / step));
  SmokeIntegral sum;
  double before_plain = 0, before_holed = 0;
  for (std::int64_t i = 0; i < count; ++i) {
    const glm::dvec3 p = a + way * ((static_cast<double>(i) + 0.5) / static_cast<double>(count));
    const double plain = density((p - glm::dvec3(frame.origin_world)) / double{frame.voxel_size});
    double holed = plain;
    if (plain > 0)
      for (const shared::Hole& hole : holes)
        holed *= 1 - double{smoke::hole_strength_masked(hole, glm::vec3(p), time, 0, masks)};
    sum.plain += plain;
    sum.holed += holed;
    if (i > 0) sum.error += std::max(std::abs(plain - before_plain), std::abs(holed - before_holed));
    before_plain = plain;
    before_holed = holed;
  }
  const double each = count == 0 ? 0 : length / static_cast<double>(count);
  return {sum.plain * each, sum.holed * each, sum.error * each};
}

}  // namespace brume::reference
