// Flat polygons into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

namespace brume::scene {

/// Most corners of a polygon that is not convex: ear clipping takes up to the third power of them.
constexpr std::size_t kMaxConcaveCorners = 1024;

/// The polygon's area vector by Newell's method (Tampieri, Graphics Gems III): along the normal, seen from
/// which the corners run counter-clockwise; its length is twice the area.
glm::dvec3 area_vector(std::span<const glm::vec3> corners);

/// Triangles that cover the polygon, as corners of it, with its winding: always corners.size() - 2 of them,
/// also when the polygon is bent, crosses itself or has no area. Convex ones become a fan, others are cut by
/// ear clipping (Meisters 1975). At least 3 corners.
std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const glm::vec3> corners);

/// True when `triangulate` needs no ear clipping.
bool is_convex(std::span<const glm::vec3> corners);

}  // namespace brume::scene
