// The maps of rays that light the voxels of a tank.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "shared/tank_light.h"

namespace brume::planning {

/// Most texels of a map: 1 GiB of half floats. Where the usual rays would be more, they lie further apart.
constexpr std::uint64_t kMostMapTexels = std::uint64_t{1} << 29;
/// Most rays along an axis, and most layers: what 3D images may have on every device.
constexpr std::uint32_t kMostMapRays = 2048;

/// Maps that reach all voxels of a tank from a light at `position` [voxels]: one along the axis along which
/// the rays spread least where the light is outside of the tank, six for a light inside.
std::vector<shared::LightMap> light_maps(const glm::vec3& position, const glm::ivec3& size,
                                         std::uint64_t most_texels = kMostMapTexels);

}  // namespace brume::planning
