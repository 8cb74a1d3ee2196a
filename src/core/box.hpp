// Axis-aligned boxes: of points in metres or voxels (float), and of voxels, cells or bricks (int).
#pragma once

#include <glm/glm.hpp>
#include <type_traits>

namespace brume {

/// The box from `low` to `high`. Boxes of integers are half-open: [low, high). Boxes of points are closed, so
/// one that is flat or a single point is not empty.
template <typename T>
struct Box {
  using Vec = glm::vec<3, T>;
  Vec low{T(0)}, high{T(0)};

  bool empty() const {
    if constexpr (std::is_integral_v<T>) return glm::any(glm::greaterThanEqual(low, high));
    return glm::any(glm::greaterThan(low, high));
  }
  /// Whether it holds a point or voxel.
  bool contains(Vec p) const {
    if constexpr (std::is_integral_v<T>)
      return glm::all(glm::greaterThanEqual(p, low)) && glm::all(glm::lessThan(p, high));
    return glm::all(glm::greaterThanEqual(p, low)) && glm::all(glm::lessThanEqual(p, high));
  }
  bool contains(const Box& other) const {
    return glm::all(glm::greaterThanEqual(other.low, low)) && glm::all(glm::lessThanEqual(other.high, high));
  }
  bool operator==(const Box&) const = default;
};

/// Holds nothing, and adds nothing to a union.
constexpr Box<float> kEmptyBox{glm::vec3(1e30f), glm::vec3(-1e30f)};

/// What both boxes hold; empty where they do not meet.
template <typename T>
Box<T> intersection(const Box<T>& a, const Box<T>& b) {
  return {glm::max(a.low, b.low), glm::min(a.high, b.high)};
}

/// The smallest box around both.
template <typename T>
Box<T> united(const Box<T>& a, const Box<T>& b) {
  return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

/// Calls visit(v) for every element of the box, x fastest.
template <typename Visit>
void for_each_in(const Box<int>& box, Visit visit) {
  for (int z = box.low.z; z < box.high.z; ++z)
    for (int y = box.low.y; y < box.high.y; ++y)
      for (int x = box.low.x; x < box.high.x; ++x) visit(glm::ivec3(x, y, z));
}

}  // namespace brume
