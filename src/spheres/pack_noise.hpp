// Smooth noise, for places and colours of packed spheres.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>

namespace brume::spheres {

/// Gradient noise (Perlin 2002, "Improving noise") of cells of edge 1, within [-1, 1].
double gradient_noise(std::uint64_t seed, const glm::dvec3& at);

}  // namespace brume::spheres
