// Ray traversal of voxel grids.
#pragma once

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>
#include <optional>

#include "shared/dda.h"
#include "voxel/bit_grid.hpp"

namespace brume::voxel {

/// Calls visit(voxel, t_enter, t_leave) in order for every voxel of the grid that the ray crosses over a t
/// interval of positive length within [0, t_max], until visit returns false. Points of the ray are
/// origin_voxel + t * direction (voxel space, any length but 0). Ties as in shared/dda.h. A ray that is not
/// finite visits nothing.
template <typename Visit>
void visit_voxels(const GridLayout& layout, glm::vec3 origin_voxel, glm::vec3 direction, float t_max,
                  Visit visit);

struct RayHit {
  glm::ivec3 voxel{0};
  float t = 0;  ///< Where the ray enters the voxel; 0 when it starts there.
  /// Outward normal of the face entered (of the first axis at an edge); 0 when the ray starts inside.
  glm::ivec3 normal{0};
};

/// The first solid voxel that visit_voxels would visit. Skips unallocated bricks in one step.
std::optional<RayHit> first_solid(const BitGrid& grid, glm::vec3 origin_voxel, glm::vec3 direction,
                                  float t_max = std::numeric_limits<float>::infinity());

/// Whether a ray can be traversed: all components finite, the direction not 0.
inline bool is_ray(glm::vec3 origin, glm::vec3 direction) {
  constexpr float kMax = std::numeric_limits<float>::max();
  const glm::vec3 o = glm::abs(origin), d = glm::abs(direction);
  return std::max({o.x, o.y, o.z, d.x, d.y, d.z}) <= kMax && glm::all(glm::equal(origin, origin)) &&
         glm::all(glm::equal(direction, direction)) && std::max({d.x, d.y, d.z}) > 0;
}

template <typename Visit>
void visit_voxels(const GridLayout& layout, glm::vec3 origin_voxel, glm::vec3 direction, float t_max,
                  Visit visit) {
  if (!is_ray(origin_voxel, direction)) return;
  shared::Dda d = shared::dda_begin(origin_voxel, direction, glm::ivec3(0), layout.size, 1, 0, t_max);
  while (d.t < d.t_end) {
    const float leave = std::min(shared::dda_min(shared::dda_leave(d)), d.t_end);
    if (!visit(d.cell, d.t, leave)) return;
    d = shared::dda_step(d);
  }
}

}  // namespace brume::voxel
