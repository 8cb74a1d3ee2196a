#include "spheres/pack_levels.hpp"

#include <algorithm>
#include <cmath>

namespace brume::spheres {
namespace {

constexpr std::uint32_t kNoNode = UINT32_MAX;

// Factor of squared distances: further from 1 than all roundings of the comparison, so that spheres that pass
// do not overlap in exact arithmetic either.
constexpr double kSafe = 1 - 0x1p-40;

double squared_distance(const glm::dvec3& a, const glm::vec3& b) {
  const glm::dvec3 d = a - glm::dvec3(b);
  return d.x * d.x + d.y * d.y + d.z * d.z;
}

bool overlap(const Sphere& a, const Sphere& b) {
  const double sum = double{a.radius} + double{b.radius};
  return squared_distance(glm::dvec3(a.center), b.center) * kSafe < sum * sum;
}

// Distance along one axis from a point to the interval of a cell.
double gap(double at, double low, double edge) {
  return std::max({low - at, at - low - edge, 0.0});
}

}  // namespace

PackLevels::PackLevels(const glm::uvec3& size, float largest, std::uint32_t count) {
  const glm::dvec3 extent(size);
  const double least_edge = std::cbrt(extent.x * extent.y * extent.z / std::max(count, 1u));
  for (double radius = largest;; radius /= 2) {
    Level level{radius, std::max(2 * radius, least_edge), {}, {}, 0};
    level.cells = glm::ivec3(glm::ceil(extent / level.edge));
    level.heads.assign(std::size_t(level.cells.x) * std::size_t(level.cells.y) * std::size_t(level.cells.z),
                       kNoNode);
    levels_.push_back(std::move(level));
    if (2 * radius <= least_edge) break;
  }
  nodes_.reserve(count);
}

PackLevels::Level& PackLevels::level_of(float radius) {
  std::size_t level = 0;
  while (level + 1 < levels_.size() && radius <= levels_[level + 1].largest) ++level;
  return levels_[level];
}

std::uint32_t& PackLevels::head_of(Level& level, const glm::vec3& center) {
  const glm::ivec3 at =
      glm::clamp(glm::ivec3(glm::dvec3(center) / level.edge), glm::ivec3(0), level.cells - 1);
  return level.heads[(std::size_t(at.z) * std::size_t(level.cells.y) + std::size_t(at.y)) *
                         std::size_t(level.cells.x) +
                     std::size_t(at.x)];
}

template <typename Visit>
bool PackLevels::for_each_head(const Level& level, const glm::dvec3& center, double radius,
                               const Visit& visit) {
  const double reach = radius + level.largest, inverse = 1 / level.edge;
  const glm::ivec3 most = level.cells - 1;
  // Inside of the tank: truncation rounds down.
  const glm::ivec3 low = glm::ivec3(glm::max(center - reach, 0.0) * inverse);
  const glm::ivec3 high = glm::min(glm::ivec3((center + reach) * inverse), most);
  for (int z = std::min(low.z, most.z); z <= high.z; ++z) {
    const double dz = gap(center.z, z * level.edge, level.edge);
    for (int y = std::min(low.y, most.y); y <= high.y; ++y) {
      const double dy = gap(center.y, y * level.edge, level.edge);
      const double rest = reach * reach - dz * dz - dy * dy;
      if (rest < 0) continue;
      const std::uint32_t* row =
          level.heads.data() +
          (std::size_t(z) * std::size_t(level.cells.y) + std::size_t(y)) * std::size_t(level.cells.x);
      for (int x = std::min(low.x, most.x); x <= high.x; ++x) {
        if (row[x] == kNoNode) continue;
        const double dx = gap(center.x, x * level.edge, level.edge);
        if (dx * dx <= rest && !visit(row[x])) return false;
      }
    }
  }
  return true;
}

double PackLevels::room(const glm::dvec3& center, double radius, double least) const {
  // The large first: they are the most probable to be in the way, in the fewest cells.
  for (const Level& level : levels_) {
    if (level.count == 0) continue;
    const bool fits = for_each_head(level, center, radius, [&](std::uint32_t head) {
      for (std::uint32_t i = head; i != kNoNode; i = nodes_[i].next) {
        const Sphere& other = nodes_[i].sphere;
        const double squared = squared_distance(center, other.center) * kSafe;
        const double sum = radius + double{other.radius};
        if (squared >= sum * sum) continue;
        if (radius <= least) return false;
        radius = std::sqrt(squared) * kSafe - double{other.radius};
        if (radius < least) return false;
      }
      return true;
    });
    if (!fits) return 0;
  }
  return radius;
}

void PackLevels::push(const Sphere& sphere) {
  Level& level = level_of(sphere.radius);
  std::uint32_t& head = head_of(level, sphere.center);
  nodes_.push_back({sphere, head});
  head = static_cast<std::uint32_t>(nodes_.size() - 1);
  ++level.count;
}

void PackLevels::pop() {
  const Node& node = nodes_.back();
  Level& level = level_of(node.sphere.radius);
  head_of(level, node.sphere.center) = node.next;
  --level.count;
  nodes_.pop_back();
}

void PackLevels::overlaps(std::uint32_t index, std::uint32_t first, std::vector<std::uint32_t>& found) const {
  const Sphere& sphere = nodes_[index].sphere;
  for (const Level& level : levels_) {
    if (level.count == 0) continue;
    for_each_head(level, glm::dvec3(sphere.center), sphere.radius, [&](std::uint32_t head) {
      // Later insertions come first in a cell.
      for (std::uint32_t i = head; i != kNoNode && i >= first; i = nodes_[i].next)
        if (i < index && overlap(sphere, nodes_[i].sphere)) found.push_back(i);
      return true;
    });
  }
}

}  // namespace brume::spheres
