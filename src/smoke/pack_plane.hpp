// Planes in 32 bits, as shared/smoke_volume.h unpacks them.
#pragma once

#include <cstdint>

#include "shared/smoke_volume.h"
#include "voxel/surface_planes.hpp"

namespace brume::smoke {

/// Returns the plane for shared::plane_normal and shared::plane_offset. Never 0. Of the octahedral grid
/// points around the normal the one nearest in angle is taken; the offset is clamped to [-1, 1].
std::uint32_t pack_plane(const voxel::Plane& plane);

}  // namespace brume::smoke
