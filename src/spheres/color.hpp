// What a tank's colours mean.
#pragma once

#include <glm/glm.hpp>

#include "spheres/tank.hpp"

namespace brume::spheres {

/// Whether a colour is an opaque surface, not a medium.
inline bool is_opaque(Color color) {
  return color >> 24 == 255;
}

/// Extinction of a colour's opacity a per voxel length, -ln(1 - a / 255); infinity where it is opaque.
double extinction_of(Color color);

/// Its red, green and blue as linear ones in [0, 1] (IEC 61966-2-1): the albedo of a surface, the
/// single-scattering albedo of a medium.
glm::vec3 albedo_of(Color color);

}  // namespace brume::spheres
