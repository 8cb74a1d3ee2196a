#include "spheres/light.hpp"

#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "shared/dda.h"
#include "shared/spheres.h"
#include "spheres/color.hpp"

namespace brume::spheres {
double exact_light(std::span<const Color> paint, const glm::uvec3& size, const glm::vec3& light_voxel,
                   const glm::ivec3& voxel) {
  BRUME_ASSERT(paint.size() == std::size_t{size.x} * size.y * size.z, std::to_string(paint.size()));
  const glm::vec3 middle = shared::voxel_middle(voxel);
  const glm::vec3 direction = light_voxel - middle;
  const double length = glm::length(glm::dvec3(direction));
  if (!(length > 0)) return 1;

  double depth = 0;
  shared::Dda d = shared::dda_begin(middle, direction, glm::ivec3(0), glm::ivec3(size), 1, 0, 1);
  for (; d.t < d.t_end && std::isfinite(depth); d = shared::dda_step(d)) {
    if (d.cell == voxel) continue;
    const auto index =
        (std::size_t(d.cell.z) * size.y + std::size_t(d.cell.y)) * size.x + std::size_t(d.cell.x);
    const Color color = paint[index];
    if (color >> 24 == 0) continue;
    const float leave = std::min(shared::dda_min(shared::dda_leave(d)), d.t_end);
    depth += extinction_of(color) * length * double{leave - d.t};
  }
  return std::exp(-depth);
}

}  // namespace brume::spheres
