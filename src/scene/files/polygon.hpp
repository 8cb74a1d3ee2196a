// Triangulation of planar polygons.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace brume::scene {

/// Maximum number of corners of a concave polygon: ear clipping takes up to cubic time.
constexpr std::size_t kMaxConcaveCorners = 1024;

/// The polygon's area vector by Newell's method (Tampieri, Graphics Gems III): along the normal from which
/// the corners appear counter-clockwise; its length is twice the area.
glm::dvec3 area_vector(std::span<const glm::vec3> corners);

/// Triangulates the polygon, keeping its winding; returns corner indices of exactly corners.size() - 2
/// triangles, also for polygons that are not planar, self-intersecting or degenerate. Convex ones become a
/// fan, others use ear clipping (Meisters 1975). At least 3 corners.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const glm::vec3> corners);

/// True when `triangulate` needs no ear clipping.
bool is_convex(std::span<const glm::vec3> corners);

}  // namespace brume::scene
