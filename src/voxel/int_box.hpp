// A box of voxels, cells or bricks.
#pragma once

#include <glm/glm.hpp>

namespace brume::voxel {

/// The half-open box [low, high).
struct IntBox {
  glm::ivec3 low{0}, high{0};
  bool empty() const { return glm::any(glm::greaterThanEqual(low, high)); }
  bool contains(glm::ivec3 v) const {
    return glm::all(glm::greaterThanEqual(v, low)) && glm::all(glm::lessThan(v, high));
  }
  bool contains(const IntBox& other) const {
    return glm::all(glm::greaterThanEqual(other.low, low)) && glm::all(glm::lessThanEqual(other.high, high));
  }
  bool operator==(const IntBox&) const = default;
};

inline IntBox intersection(const IntBox& a, const IntBox& b) {
  return {glm::max(a.low, b.low), glm::min(a.high, b.high)};
}

/// Calls visit(v) for every element of the box, x fastest.
template <typename Visit>
void for_each_in(const IntBox& box, Visit visit) {
  for (int z = box.low.z; z < box.high.z; ++z)
    for (int y = box.low.y; y < box.high.y; ++y)
      for (int x = box.low.x; x < box.high.x; ++x) visit(glm::ivec3(x, y, z));
}

}  // namespace brume::voxel
