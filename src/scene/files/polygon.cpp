#include "scene/files/polygon.hpp"

#include <cmath>
#include <numeric>

namespace brume::scene {
namespace {

/// The corners projected along the area vector's dominant axis: still counter-clockwise.
std::vector<glm::dvec2> flattened(std::span<const glm::vec3> corners) {
  const glm::dvec3 area = area_vector(corners);
  const glm::dvec3 size = glm::abs(area);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  std::vector<glm::dvec2> flat;
  flat.reserve(corners.size());
  for (const glm::vec3& corner : corners) {
    const glm::dvec3 p(corner);
    glm::dvec2 q(p[(axis + 1) % 3], p[(axis + 2) % 3]);
    if (area[axis] < 0) q.x = -q.x;
    flat.push_back(q);
  }
  return flat;
}

/// Twice the signed area: positive when a, b, c turn left.
double turn(glm::dvec2 a, glm::dvec2 b, glm::dvec2 c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool all_turn_left(const std::vector<glm::dvec2>& flat) {
  const std::size_t count = flat.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (turn(flat[i], flat[(i + 1) % count], flat[(i + 2) % count]) < 0) return false;
  }
  return true;
}

bool is_ear(const std::vector<glm::dvec2>& flat, const std::vector<std::uint32_t>& ring, std::size_t at) {
  const std::size_t count = ring.size();
  const std::size_t before = (at + count - 1) % count, after = (at + 1) % count;
  const glm::dvec2 a = flat[ring[before]], b = flat[ring[at]], c = flat[ring[after]];
  if (turn(a, b, c) <= 0) return false;
  for (std::size_t i = 0; i < count; ++i) {
    if (i == before || i == at || i == after) continue;
    const glm::dvec2 p = flat[ring[i]];
    if (p == a || p == b || p == c) continue;
    if (turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0) return false;
  }
  return true;
}

}  // namespace

glm::dvec3 area_vector(std::span<const glm::vec3> corners) {
  glm::dvec3 sum(0);
  const glm::dvec3 base(corners[0]);
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    sum += glm::cross(glm::dvec3(corners[i]) - base, glm::dvec3(corners[i + 1]) - base);
  }
  return sum;
}

bool is_convex(std::span<const glm::vec3> corners) {
  return corners.size() == 3 || all_turn_left(flattened(corners));
}

std::vector<std::array<std::uint32_t, 3>> triangulate(std::span<const glm::vec3> corners) {
  std::vector<std::array<std::uint32_t, 3>> triangles;
  triangles.reserve(corners.size() - 2);
  std::vector<std::uint32_t> ring(corners.size());
  std::iota(ring.begin(), ring.end(), 0u);

  if (corners.size() > 3) {
    const std::vector<glm::dvec2> flat = flattened(corners);
    // Clip ears until a triangle remains, or a self-intersecting polygon without ears.
    bool found = !all_turn_left(flat);
    while (found && ring.size() > 3) {
      found = false;
      for (std::size_t at = 0; at < ring.size() && !found; ++at) {
        if (!is_ear(flat, ring, at)) continue;
        const std::size_t count = ring.size();
        triangles.push_back({ring[(at + count - 1) % count], ring[at], ring[(at + 1) % count]});
        ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
        found = true;
      }
    }
  }
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) triangles.push_back({ring[0], ring[i], ring[i + 1]});
  return triangles;
}

}  // namespace brume::scene
