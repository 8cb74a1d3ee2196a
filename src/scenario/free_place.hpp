// Places where a smoke has room.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

#include "voxel/bit_grid.hpp"

namespace brume::scenario {

/// The voxel that a point lies in, which may be outside of the grid.
glm::ivec3 voxel_of(const voxel::GridLayout& layout, glm::vec3 at_world);
glm::vec3 centre_of(const voxel::GridLayout& layout, glm::ivec3 voxel);

/// The centre of the nearest free voxel from which smoke fills at least `voxels`, the voxel of the point
/// itself first; one with something solid below it if there is any. Nothing within 48 voxels.
std::optional<glm::vec3> nearest_free_place(const voxel::BitGrid& grid, glm::vec3 at_world,
                                            std::uint32_t voxels);

}  // namespace brume::scenario
