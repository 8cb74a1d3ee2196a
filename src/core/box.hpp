// Axis-aligned boxes: of points in metres or voxels (float), and of voxels, cells or bricks (int).
#pragma once

#include <algorithm>
#include <cstddef>
#include <glm/glm.hpp>
#include <limits>
#include <type_traits>
#include <utility>
#include <vector>

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

/// Joins boxes until there are at most `most`, first the two whose union gains the least volume. The time
/// grows with the cube of their number.
template <typename T, typename Memory>
void join_nearest(std::vector<Box<T>, Memory>& boxes, std::size_t most) {
  const auto volume = [](const Box<T>& box) {
    const glm::dvec3 size(box.high - box.low);
    return size.x * size.y * size.z;
  };
  while (boxes.size() > std::max<std::size_t>(most, 1)) {
    std::pair<std::size_t, std::size_t> best{0, 1};
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < boxes.size(); ++i)
      for (std::size_t k = i + 1; k < boxes.size(); ++k) {
        const double gained = volume(united(boxes[i], boxes[k])) - volume(boxes[i]) - volume(boxes[k]);
        if (gained >= least) continue;
        least = gained;
        best = {i, k};
      }
    boxes[best.first] = united(boxes[best.first], boxes[best.second]);
    boxes.erase(boxes.begin() + static_cast<std::ptrdiff_t>(best.second));
  }
}

/// Calls visit(v) for every element of the box, x fastest.
template <typename Visit>
void for_each_in(const Box<int>& box, Visit visit) {
  for (int z = box.low.z; z < box.high.z; ++z)
    for (int y = box.low.y; y < box.high.y; ++y)
      for (int x = box.low.x; x < box.high.x; ++x) visit(glm::ivec3(x, y, z));
}

}  // namespace brume
