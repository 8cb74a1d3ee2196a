// Divides a sparse volume into convex parts, each for a renderer of its own: boxes of bricks that a k-d tree
// separates, so that from any point they have one order of visibility.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "core/error.hpp"
#include "volume/sparse_volume.hpp"

namespace brume::volume {

class Parts {
 public:
  /// About the same number of slots in each part, and at least one. Fails with usage where there are too few
  /// bricks, or none of the planes between them divides them so.
  static Result<Parts> divide(const SparseVolume& volume, std::uint32_t count);

  std::uint32_t count() const { return count_; }
  /// The part that a brick belongs to; every brick, of the volume or not, belongs to one.
  std::uint32_t part_of(glm::ivec3 brick) const;
  /// All parts, the nearest first: what is in one never hides what is in those before it. The eye is in voxel
  /// space.
  std::vector<std::uint32_t> order_from(glm::vec3 eye) const;

 private:
  struct Node {
    int axis = 0;
    int plane = 0;                      ///< Bricks below it, along the axis, are in the first child.
    std::uint32_t first = 0, count;     ///< Parts; the first child's come first.
    std::uint32_t left = 0, right = 0;  ///< Nodes, where `count` is above 1.
  };
  bool split(std::uint32_t node, std::span<glm::ivec3> bricks);

  std::uint32_t count_ = 0;
  std::vector<Node> nodes_;
};

/// A volume of the bricks of one part, with the bounds of the whole (SparseVolume::set_extent): rays are
/// divided into the same steps in all parts. It has at least one slot. It has the channels of the whole.
SparseVolume part_of_volume(const SparseVolume& whole, const Parts& parts, std::uint32_t part);

}  // namespace brume::volume
