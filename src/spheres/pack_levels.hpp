// The spheres that are packed so far, in one grid of cells per level of radii.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "spheres/tank.hpp"

namespace brume::spheres {

/// Spheres numbered in the order of their insertion. Level 0 holds radii above half of the largest, each
/// further one the next factor of 2; the last one all that are smaller. Cells are as wide as the largest
/// sphere of their level, but not so small that there would be more of them than spheres: a search visits few
/// cells, and few spheres in each.
class PackLevels {
 public:
  PackLevels(const glm::uvec3& size, float largest, std::uint32_t count);

  /// Radius of the largest sphere at `center` that overlaps none and is not above `radius`; 0 where that
  /// would be below `least`. Not of the tank's sides.
  double room(const glm::dvec3& center, double radius, double least) const;

  /// Inserts a sphere inside of the tank, of a radius up to the largest.
  void push(const Sphere& sphere);
  /// Removes the sphere that was inserted last.
  void pop();
  std::uint32_t count() const { return static_cast<std::uint32_t>(nodes_.size()); }
  const Sphere& operator[](std::uint32_t index) const { return nodes_[index].sphere; }

  /// Appends to `found` the spheres from number `first` on, but before `index`, that overlap sphere `index`.
  void overlaps(std::uint32_t index, std::uint32_t first, std::vector<std::uint32_t>& found) const;

 private:
  struct Node {
    Sphere sphere;
    std::uint32_t next;  ///< Sphere of the same cell that was inserted before it, or kNone.
  };
  struct Level {
    double largest;  ///< Radius.
    double edge;     ///< Edge of a cell.
    glm::ivec3 cells;
    std::vector<std::uint32_t> heads;  ///< Last sphere inserted into each cell, or kNone.
    std::uint32_t count = 0;
  };
  Level& level_of(float radius);
  std::uint32_t& head_of(Level& level, const glm::vec3& center);
  /// Calls visit(head) for the cells of a level whose spheres may reach into a ball, until it returns false.
  template <typename Visit>
  static bool for_each_head(const Level& level, const glm::dvec3& center, double radius, const Visit& visit);

  std::vector<Level> levels_;
  std::vector<Node> nodes_;
};

}  // namespace brume::spheres
